# shellcheck shell=bash
# A Debian that has nothing else, in a folder; for commands that source scripts/common.sh first. They need root and the packages of
# scripts/dependencies/bare_machine.txt. Packages come from where apt gets those of this machine.
[ "$(id -u)" = 0 ] || refuse "this needs root: it installs into a folder as if that were a machine"
# shellcheck source=/dev/null
release_here=$(. /etc/os-release && echo "$VERSION_CODENAME")

bare_debian() { # FOLDER RELEASE LOG
    local mirror
    mirror=$(apt-get indextargets --format '$(REPO_URI)' "Codename: $release_here" | sort -u | head -1)
    mkdir -p "$1"
    chmod 755 "$1" # apt reads as another user
    debootstrap --variant=minbase "$2" "$1" "$mirror" >"$3" 2>&1 || { tail -20 "$3" >&2; exit 1; }
    mount -t proc proc "$1/proc"
}
