import * as THREE from 'three';
import { HEM, SCALE, TINTS, WRONG } from './colours';
import { matte } from './material';

/** The common properties of the materials of a cloth's two sides and its edge. */
export class FabricUniforms {
    /** 1 for colours by depth, otherwise 0. */
    readonly byDepth = { value: 0 };
    /** 1 where pieces differ in colour. */
    readonly tinted = { value: 0 };
    /** The edge of a square sheet, with a border woven in; 0: none. */
    readonly hem = { value: 0 };
    readonly scale = { value: SCALE.map((hex) => new THREE.Color(hex)) };
    readonly tints = { value: TINTS.map((hex) => new THREE.Color(hex)) };
    readonly hemColour = { value: new THREE.Color(HEM) };
    readonly inside = { value: new THREE.Color(WRONG) };
}

/**
 * For colours by depth, each particle's depth is mapped to the palette's scale; a particle inside gets the colour of what is wrong.
 * @param lift  how far this side is from the particles, along their normals
 */
export function fabric(front: number, back: number, uniforms: FabricUniforms, lift: { value: number }): THREE.MeshLambertMaterial {
    const material = matte(front, back);
    const { onBeforeCompile } = material;
    material.onBeforeCompile = (shader, renderer) => {
        onBeforeCompile(shader, renderer);
        Object.assign(shader.uniforms, uniforms, { lift });
        shader.vertexShader = shader.vertexShader
            .replace('#include <common>', '#include <common>\nattribute float contactDepth;\nattribute float tint;\nuniform float lift;\nvarying float vContactDepth;\nvarying float vTint;\nvarying vec2 vWeave;')
            .replace('#include <begin_vertex>', '#include <begin_vertex>\nvContactDepth = contactDepth;\nvTint = tint;\nvWeave = uv;\ntransformed += lift * normal;');
        shader.fragmentShader = shader.fragmentShader
            .replace('#include <common>', `#include <common>\n${DECLARATIONS}`)
            .replace('#include <alphamap_fragment>', `${COLOUR}\n#include <alphamap_fragment>`) // after matte() has chosen the side's colour
            .replace('#include <opaque_fragment>', `${SHEEN}\n#include <opaque_fragment>`);
    };
    return material;
}

const DECLARATIONS = `
    uniform float byDepth, tinted, hem;
    uniform vec3 scale[5], tints[3], hemColour, inside;
    varying float vContactDepth, vTint;
    varying vec2 vWeave;
    float stripe(float from, float to, float at, float blur) {
        return smoothstep(from - blur, from + blur, at) - smoothstep(to - blur, to + blur, at);
    }`;

const COLOUR = `
    if (tinted > 0.0) {
        vec3 own = vTint < 0.5 ? mix(tints[0], tints[1], 2.0 * vTint) : mix(tints[1], tints[2], 2.0 * vTint - 1.0);
        diffuseColor.rgb = gl_FrontFacing ? own : 0.75 * own;
    }
    if (hem > 0.0) {
        vec2 corner = min(vWeave, hem - vWeave);
        float fromEdge = min(corner.x, corner.y), blur = 0.75 * fwidth(fromEdge) + 1e-4;
        float woven = max(stripe(0.10, 0.125, fromEdge, blur), stripe(0.145, 0.155, fromEdge, blur));
        diffuseColor.rgb = mix(diffuseColor.rgb, hemColour, 0.75 * woven);
    }
    float place = 4.0 * clamp(vContactDepth, 0.0, 1.0);
    vec3 shade = scale[0];
    for (int i = 0; i < 4; ++i) shade = mix(shade, scale[i + 1], clamp(place - float(i), 0.0, 1.0));
    if (vContactDepth > 1.0) shade = inside;
    diffuseColor.rgb = mix(diffuseColor.rgb, shade, byDepth);`;

/** Loose fibres, which catch the light where the cloth turns away. */
const SHEEN = `
    #ifdef FINE
        float turned = 1.0 - saturate(dot(normalize(vViewPosition), normal));
        outgoingLight += 0.35 * turned * turned * turned * (diffuseColor.rgb + 0.08);
    #endif`;

/** Threads to the length of one on the fabric. */
const THREADS = 90;

/** Heights of a plain weave: two threads each way, over and under. Its mipmaps flatten it at a distance. */
export function weaveTexture(): THREE.Texture {
    const side = 64, half = side / 2;
    const pixels = new Uint8Array(4 * side * side);
    for (let y = 0; y < side; ++y)
        for (let x = 0; x < side; ++x) {
            const over = Math.floor(x / half) === Math.floor(y / half);
            const [across, along] = over ? [x, y] : [y, x];
            const round = Math.sin((Math.PI * ((across % half) + 0.5)) / half), arch = Math.sin((Math.PI * ((along % half) + 0.5)) / half);
            pixels.set([255 * Math.sqrt(round) * (0.45 + 0.55 * arch), 0, 0, 255], 4 * (y * side + x));
        }
    const texture = new THREE.DataTexture(pixels, side, side);
    texture.wrapS = texture.wrapT = THREE.RepeatWrapping;
    texture.repeat.setScalar(THREADS / 2);
    texture.magFilter = THREE.LinearFilter;
    texture.minFilter = THREE.LinearMipmapLinearFilter;
    texture.anisotropy = 8;
    texture.generateMipmaps = true;
    texture.needsUpdate = true;
    return texture;
}
