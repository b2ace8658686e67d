#!/usr/bin/env bash
# Checks exact maps by CGAL's exact predicates and writes the tables of docs/accuracy.md: every generated
# mesh, and every mesh of a folder. Takes about an hour with ten million points; a few minutes with --points
# 500000.
#
#   scripts/bench accuracy [--points N] [FOLDER]     FOLDER: the meshes of ECHINUS_SHARED, where it is at hand
#
# Fails when a mesh does not pass; the tables are written all the same. Each mesh's figures, by rule and kind
# of point, are left in out/accuracy/MESH.json.
set -euo pipefail
cd "$(dirname "$0")/../../.."
points=10000000
folder=${ECHINUS_SHARED:?is set by scripts/bench}/meshes
out=out/accuracy
page=docs/accuracy.md
check=build/release/tests/echinus-check

while [ $# -gt 0 ]; do
    case "$1" in
    --points)
        [ $# -gt 1 ] || { echo "accuracy: --points needs a number" >&2; exit 2; }
        points=$2
        shift 2
        ;;
    -*)
        echo "accuracy: unknown option '$1'; usage: scripts/bench accuracy [--points N] [FOLDER]" >&2
        exit 2
        ;;
    *)
        [ -d "$1" ] || { echo "accuracy: there is no folder '$1'" >&2; exit 2; }
        folder=$1
        shift
        ;;
    esac
done

status=0
judge() { # NAME, then how echinus-check gets the mesh
    local name=$1 code=0
    shift
    "$check" "$@" --points "$points" --json >"$out/$name.json" || code=$?
    if [ $code -gt 1 ] || ! jq --exit-status . "$out/$name.json" >/dev/null 2>&1; then
        echo "accuracy: echinus-check failed on $name" >&2
        rm -f "$out/$name.json"
        status=1
    elif [ $code = 1 ]; then
        echo "accuracy: not all answers about $name hold; see $out/$name.json" >&2
        status=1
    fi
}

# rows CLOSED FORMAT: a table's rows, from all meshes that are closed, or open.
rows() {
    jq --raw-output --slurp --argjson closed "$1" \
        'def small: . * 1e8 | round / 100;
         def percent: . * 1e6 | round / 1e4;
         .[] | select(.closed == $closed) as $mesh | $mesh.rules | to_entries[] | .value as $r |
         ([$mesh.mesh, $mesh.faces, ($mesh.bytes / 1e3 | round)] + [.key, $r.points] +
          (if $closed then [$r.wrong_inside, $r.ambiguous, $r.wrong_snapped]
           else [($r.agreement | percent), $r.disagreements_certain, ($r.certain_share | percent)] end) +
          [$r.inconsistent, ($r.worst_distance_error | small), ($r.worst_point_error | small),
           ($r.worst_normal_error_deg * 1000 | round / 1000)]) | "| " + (map(tostring) | join(" | ")) + " |"' \
        "$out"/*.json
}

write_tables() {
    echo
    echo "$points points per mesh, a quarter of each kind, seed 1; $(date +%F), commit $(git rev-parse --short HEAD)."
    echo
    echo "**Closed surfaces**"
    echo
    echo "| mesh | faces | kB | rule | points | wrong | ambiguous | wrong on the lattice | inconsistent | distance, 1e-6 R | contact point, 1e-6 R | normal, degrees |"
    echo "|---|---|---|---|---|---|---|---|---|---|---|---|"
    rows true
    echo
    echo "**Open and non-manifold surfaces**"
    echo
    echo "| mesh | faces | kB | rule | points | agreement, % | certain and wrong | certain, % of the sphere | inconsistent | distance, 1e-6 R | contact point, 1e-6 R | normal, degrees |"
    echo "|---|---|---|---|---|---|---|---|---|---|---|---|"
    rows false
    echo
}

cmake --preset release --log-level=WARNING
cmake --build --preset release --target echinus-check --parallel "$(nproc)"
rm -rf "$out"
mkdir -p "$out"
while read -r name; do
    judge "$name" --generate "$name"
done < <("$check" --list)
for file in "$folder"/*.obj "$folder"/*.off; do
    [ -e "$file" ] || continue # the folder is absent
    name=$(basename "${file%.*}")
    judge "$name" "$file"
done

# Replaces the text between the page's markers; the prose around them stays.
tables=$out/tables.md
write_tables >"$tables"
sed -i -e "/^<!-- tables/,/^<!-- end of tables/{/^<!-- tables/{p;r $tables" -e "};/^<!-- end of tables/p;d}" "$page"
printf '\nDone in %d s. See %s\n' "$SECONDS" "$page"
exit $status
