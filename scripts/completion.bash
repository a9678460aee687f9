# Completion of osculate's commands, options, tutorials and keys in bash:   source scripts/completion.bash
_osculate() {
    local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]} command=${COMP_WORDS[1]} words
    if [ "$COMP_CWORD" -eq 1 ]; then
        words=$(osculate --help | sed -n '/^Subcommands:/,$s/^  \([a-z][a-z-]*\) .*/\1/p')
    elif [[ $word = -* ]]; then
        words=$(osculate "$command" --help | grep -oE '(^|[ ,])--?[a-z][a-z-]*' | tr -d ' ,')
    elif [ "$before" = --set ] || [ "$command" = keys ]; then
        words=$(osculate keys | grep -v '^ ')
    elif [ "$command" = init ] && [ "$COMP_CWORD" -eq 2 ]; then
        words=$(osculate init --list | cut -d ' ' -f 1)
    elif [ "$command" = schema ]; then
        words="scene study template"
    elif [ "$command" = diary ] || [ "$command" = resume ] || [ "$before" = -o ]; then
        mapfile -t COMPREPLY < <(compgen -d -- "$word")
        return
    elif [ "$command" = import ]; then
        mapfile -t COMPREPLY < <(compgen -f -X '!*.inp' -- "$word"; compgen -d -S / -- "$word")
        return
    elif [ "$command" = mesh ]; then
        mapfile -t COMPREPLY < <(compgen -f -- "$word")
        return
    else
        mapfile -t COMPREPLY < <(compgen -f -X '!*.yaml' -- "$word"; compgen -d -S / -- "$word")
        return
    fi
    mapfile -t COMPREPLY < <(compgen -W "$words" -- "$word")
}
complete -o nospace -F _osculate osculate
