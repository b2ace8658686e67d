# shellcheck shell=bash
# For scripts that build the page: Vite needs Node 20.19, 22.12 or newer, and Debian 12 has 18. Sourced from the
# repository's root.

node_is_recent() {
    local major minor
    IFS=. read -r major minor _ <<<"$(node --version | tr -d v)"
    ((major > 22 || (major == 22 && minor >= 12) || (major == 20 && minor >= 19)))
}

# Puts a Node that is new enough in front of PATH, once fetched from the npm registry into build/node/, where the
# machine's own is older. Not for npm: Debian's finds its parts only by Debian's Node.
use_recent_node() {
    node_is_recent && return
    local version=22.23.3 platform package
    case "$(uname -m)" in
    x86_64) platform=x64 ;;
    aarch64) platform=arm64 ;;
    *)
        echo "web: building the page takes Node 20.19, 22.12 or newer; this is $(node --version)" >&2
        return 1
        ;;
    esac
    package=node-linux-$platform
    if [ ! -x "build/node/$version/node_modules/$package/bin/node" ]; then
        echo "web: fetching Node $version, since the one here is $(node --version)" >&2
        npm --prefix "build/node/$version" install --no-save --no-audit --no-fund --loglevel=error "$package@$version"
    fi
    PATH=$PWD/build/node/$version/node_modules/$package/bin:$PATH
}
