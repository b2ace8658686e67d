/** An answer that needs the classes to be whole after a bundler has dropped what nothing uses. */
export function answer(echinus) {
    const map = echinus.buildMap(echinus.makeTorus(1, 0.4, 60, 24));
    const { inside, depth } = map.contactsBatch(Float32Array.of(1.3, 0.1, 0.1), 0, echinus.makeContacts(1)).at(0);
    return `${inside ? 'inside' : 'outside'}, ${depth.toFixed(2)} deep`;
}
