// Mesh files as other programs write them.

const CORNERS = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]];
const FACES = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
const lines = (rows) => rows.map((row) => `${row}\n`).join('');

/** A tetrahedron in each format, by file name. */
export function tetrahedra() {
    const corners = CORNERS.map((corner) => corner.join(' '));
    const polygons = FACES.map((face) => `3 ${face.join(' ')}`);
    return {
        't.obj': lines([...corners.map((corner) => `v ${corner}`), ...FACES.map((face) => `f ${face.map((i) => i + 1).join(' ')}`)]),
        't.ply': lines([
            'ply', 'format ascii 1.0', 'element vertex 4', 'property float x', 'property float y', 'property float z',
            'element face 4', 'property list uchar int vertex_indices', 'end_header', ...corners, ...polygons,
        ]),
        't.stl': lines(['solid t', ...FACES.flatMap((face) => ['facet normal 0 0 0', 'outer loop', ...face.map((i) => `vertex ${corners[i]}`), 'endloop', 'endfacet']), 'endsolid t']),
        't.off': lines(['OFF', '4 4 0', ...corners, ...polygons]),
        't.glb': tetrahedronGlb(),
    };
}

/** The numbers of a tetrahedron as glTF has them: corners, then faces. */
export const gltfNumbers = () => Buffer.concat([Buffer.from(new Float32Array(CORNERS.flat()).buffer), Buffer.from(new Uint16Array(FACES.flat()).buffer)]);

/** Their description, without the optional default scene and the location of the numbers. */
function gltfDescription(buffer) {
    return {
        asset: { version: '2.0' }, scenes: [{ nodes: [0] }], nodes: [{ mesh: 0 }],
        meshes: [{ primitives: [{ attributes: { POSITION: 0 }, indices: 1 }] }],
        buffers: [{ byteLength: 72, ...buffer }],
        bufferViews: [{ buffer: 0, byteOffset: 0, byteLength: 48 }, { buffer: 0, byteOffset: 48, byteLength: 24 }],
        accessors: [
            { bufferView: 0, componentType: 5126, count: 4, type: 'VEC3', min: [0, 0, 0], max: [1, 1, 1] },
            { bufferView: 1, componentType: 5123, count: 12, type: 'SCALAR' },
        ],
    };
}

/** A tetrahedron as text glTF, with its texture or its numbers in another file. */
export function gltfTetrahedron({ texture, buffer = `data:application/octet-stream;base64,${gltfNumbers().toString('base64')}` }) {
    const description = gltfDescription({ uri: buffer });
    if (texture) {
        description.images = [{ uri: texture }];
        description.textures = [{ source: 0 }];
        description.materials = [{ pbrMetallicRoughness: { baseColorTexture: { index: 0 } } }];
        description.meshes[0].primitives[0].material = 0;
    }
    return JSON.stringify(description);
}

/** A tetrahedron as the binary kind of glTF: a header, a JSON chunk, a chunk of numbers. */
function tetrahedronGlb() {
    const numbers = gltfNumbers();
    const json = JSON.stringify({ scene: 0, ...gltfDescription({}) });
    const text = Buffer.from(json.padEnd(4 * Math.ceil(json.length / 4)));
    const words = (...values) => Buffer.from(new Uint32Array(values).buffer);
    return Buffer.concat([
        words(0x46546c67, 2, 28 + text.length + numbers.length), words(text.length, 0x4e4f534a), text, words(numbers.length, 0x004e4942), numbers,
    ]);
}

/** A torus as a binary STL file: 80 bytes, a count, and for each triangle a normal, its corners and two bytes. */
export function torusStl(major, minor) {
    const bytes = Buffer.alloc(84 + 50 * 2 * major * minor);
    bytes.writeUInt32LE(2 * major * minor, 80);
    const point = (i, j) => {
        const [u, v] = [(2 * Math.PI * (i % major)) / major, (2 * Math.PI * (j % minor)) / minor];
        const across = 1 + 0.4 * Math.cos(v);
        return [across * Math.cos(u), across * Math.sin(u), 0.4 * Math.sin(v)];
    };
    let at = 84;
    const write = (...corners) => {
        corners.flat().forEach((value, k) => bytes.writeFloatLE(value, at + 12 + 4 * k));
        at += 50;
    };
    for (let i = 0; i < major; ++i)
        for (let j = 0; j < minor; ++j) {
            const [a, b, c, d] = [point(i, j), point(i + 1, j), point(i + 1, j + 1), point(i, j + 1)];
            write(a, b, c);
            write(a, c, d);
        }
    return bytes;
}
