# shellcheck shell=bash
# For scripts that use packages of the npm registry. Sourced from the repository's root. Vite needs Node 20.19, 22.12 or
# newer, but Debian 12 has 18.

node_is_recent() {
    local major minor
    IFS=. read -r major minor _ <<<"$(node --version | tr -d v)"
    ((major > 22 || (major == 22 && minor >= 12) || (major == 20 && minor >= 19)))
}

# Where the machine's Node is too old, prepends a newer one, with its own npm, to PATH; fetched once from the npm
# registry into build/node/. Debian's npm does not help: it runs with Debian's Node only, and then skips packages that
# require a newer one.
use_recent_node() {
    node_is_recent && return
    local version=22.23.3 platform folder
    case "$(uname -m)" in
    x86_64) platform=x64 ;;
    aarch64) platform=arm64 ;;
    *)
        echo "web: building the page takes Node 20.19, 22.12 or newer; this is $(node --version)" >&2
        return 1
        ;;
    esac
    folder=$PWD/build/node/$version
    if [ ! -e "$folder/complete" ]; then
        echo "web: fetching Node $version, since the one here is $(node --version)" >&2
        npm --prefix "$folder" install --no-save --no-audit --no-fund --loglevel=error "node-linux-$platform@$version" npm@10.9.4
        touch "$folder/complete"
    fi
    PATH=$folder/node_modules/node-linux-$platform/bin:$folder/node_modules/.bin:$PATH
}

# install_packages FOLDER: what its package-lock.json lists; again only when that has changed.
install_packages() {
    cmp --silent "$1/package-lock.json" "$1/node_modules/.installed" && return
    npm --prefix "$1" ci --install-links=false --no-audit --no-fund --loglevel=error
    cp "$1/package-lock.json" "$1/node_modules/.installed"
}
