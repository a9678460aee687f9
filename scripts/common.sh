# shellcheck shell=bash disable=SC2034
# What the bash commands of scripts/ have in common. Each sources this first, before it looks at its arguments:
# -h or --help, anywhere, prints the comment at the command's top; --no-install is taken out of "$@" and kept for
# install_packages.
#   scripts   this folder                root     of the repository
#   here      folder of the command      folder   of the build, absolute: OSCULATE_BUILD, default build/release
set -euo pipefail
itself=${BASH_SOURCE[1]}
here=$(cd "$(dirname "$itself")" && pwd)
scripts=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
root=$(dirname "$scripts")
export PYTHONDONTWRITEBYTECODE=1 # no folders of Python's beside the sources

print_help() { sed -n '2,${/^#/!q;s/^# \{0,1\}//p}' "$itself"; }

refuse() { # WHAT IS WRONG with the command line
    echo "$1" >&2
    print_help >&2
    exit 2
}

takes_nothing_else() { # what is left of the arguments
    [ $# -eq 0 ] || refuse "unknown option or argument: $*"
}

build_in() { # DEFAULT, a folder of the repository: where OSCULATE_BUILD names none
    folder=${OSCULATE_BUILD:-$1}
    [[ $folder = /* ]] || folder=$root/$folder
}

install_packages() { # [NAME...]: of dependencies/base.txt and of dependencies/NAME.txt
    local lists=("${@/#/scripts/dependencies/}")
    "$scripts/install" "${no_install[@]}" scripts/dependencies/base.txt "${lists[@]/%/.txt}"
}

build() { # [TARGET...]
    OSCULATE_BUILD=$folder "$scripts/build" "$@"
}

# Last line of a page that was written: by which version, and when.
stamp() { # PAGE
    local version
    version=$("$folder/osculate" --version)
    printf '\n*Osculate %s, %s.*\n' "${version#osculate }" "$(date +%F)" >>"$1"
}

# BLAS in one thread: the sparse solvers call small dense kernels, where threads cost more than they give.
one_thread() { export OPENBLAS_NUM_THREADS=1 OMP_NUM_THREADS=1; }
one_thread_unless_told() { export OPENBLAS_NUM_THREADS=${OPENBLAS_NUM_THREADS:-1} OMP_NUM_THREADS=${OMP_NUM_THREADS:-1}; }

no_install=() arguments=()
for argument in "$@"; do
    case "$argument" in
        -h | --help) print_help; exit 0 ;;
        --no-install) no_install=(--no-install) ;;
        *) arguments+=("$argument") ;;
    esac
done
set -- "${arguments[@]}"
build_in build/release
