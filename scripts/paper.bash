# The paper's models, maps, simulations and figures, for scripts/demo and scripts/bench reproduction; sourced, not run.
# The caller sets `echinus`, the program, and `out`, the folder for what is made.

step() { printf '\n== %s (%d s)\n' "$*" "$SECONDS"; }

# The paper's torus has 2880 faces; the horse's faults are mended when its map is built.
make_maps() {
    local common=(--kind distance --directions 200x200 --correction signed --json) # as in the paper: 200 x 200
    "$echinus" mesh torus --major 1 --minor 0.4 --segments 60x24 -o "$out/torus.obj"
    "$echinus" build models/horse.3ds --repair "${common[@]}" -o "$out/horse.ech" >"$out/horse_map.json"
    "$echinus" build "$out/torus.obj" "${common[@]}" -o "$out/torus.ech" >"$out/torus_map.json"
}

drape() { # horse or torus; every fifth of 240 frames a second is kept, twice as many as a film has
    "$echinus" simulate "scenes/$1_distance.json" --every 5 -o "$out/$1"
}

draw_figures() { # FOLDER; after drape: the mended horse, of which the map is, lies beside its cloth
    "$echinus" render map "$out/horse.ech" "$out/horse/collider.obj" --up y -o "$1/horse_map.png"
    "$echinus" render map "$out/torus.ech" "$out/torus.obj" -o "$1/torus_map.png"
    "$echinus" render sheet "$out/horse" -o "$1/horse_cloth.png"
    "$echinus" render sheet "$out/torus" -o "$1/torus_cloth.png"
}
