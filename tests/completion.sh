# What bash completes:   bash tests/completion.sh OSCULATE, from the root of the repository
set -euo pipefail
PATH=$(dirname "$1"):$PATH
source scripts/completion.bash
faults=0
expect() { # WORD that is offered, at the end of WORDS...
    local wanted=$1
    shift
    COMP_WORDS=("$@") COMP_CWORD=$(($# - 1)) COMPREPLY=()
    _osculate
    printf '%s\n' "${COMPREPLY[@]}" | grep -qxF -- "$wanted" || { echo "$*: does not offer $wanted"; faults=1; }
}
expect study osculate st
expect surface-study osculate su
expect --threads osculate run --th
expect press_block osculate init pr
expect tests/scenes/press.yaml osculate run tests/scenes/pre
expect contact.joint.friction osculate run tests/scenes/press.yaml --set contact.joint.fr
expect bodies.cap.material.linear_elastic.E osculate run tests/scenes/press.yaml --set bodies.cap.ma
expect stages.pull.steps osculate check tests/scenes/press.yaml --set stages.p
expect 'contact.<pair>.friction' osculate keys contact.
exit $faults
