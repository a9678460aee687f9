# Completion of osculate's commands, options, tutorials and keys in bash:   source scripts/completion.bash
# Keys for --set, with the names that stand in the scene of the command line: contact.base.friction for contact.<pair>.friction.
_osculate_keys() {
    local word scene=
    for word in "${COMP_WORDS[@]}"; do [[ $word = *.yaml && -f $word ]] && scene=$word; done
    osculate keys | grep -v '^ ' | awk -v scene="$scene" '
        BEGIN {
            while (scene != "" && (getline line < scene) > 0) {
                if (match(line, /^[a-z]+:/)) section = substr(line, 1, RLENGTH - 1)
                else if (match(line, /^  [A-Za-z_][A-Za-z_0-9]*:/)) names[section] = names[section] " " substr(line, 3, RLENGTH - 3)
            }
        }
        {
            parts = split($0, part, ".")
            if (parts < 2 || part[2] !~ /^</ || names[part[1]] == "") { print; next }
            rest = substr($0, length(part[1] part[2]) + 2)
            count = split(names[part[1]], name, " ")
            for (i = 1; i <= count; ++i) print part[1] "." name[i] rest
        }'
}
_osculate() {
    local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]} command=${COMP_WORDS[1]} words
    if [ "$COMP_CWORD" -eq 1 ]; then
        words=$(osculate --help | sed -n '/^Subcommands:/,$s/^  \([a-z][a-z, -]*[a-z]\)  .*/\1/p' | tr -d ,)
    elif [[ $word = -* ]]; then
        words=$(osculate "$command" --help | grep -oE '(^|[ ,])--?[a-z][a-z-]*' | tr -d ' ,')
    elif [ "$before" = --set ]; then
        words=$(_osculate_keys)
    elif [ "$command" = keys ]; then
        words=$(osculate keys | grep -v '^ ')
    elif [ "$command" = init ] && [ "$COMP_CWORD" -eq 2 ]; then
        words=$(osculate init --list | cut -d ' ' -f 1)
    elif [ "$command" = schema ]; then
        words="scene study template"
    elif [ "$command" = diary ] || [ "$command" = report ] || [ "$command" = view ] || [ "$command" = film ] || [ "$command" = resume ] || [ "$before" = -o ]; then
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
