import * as THREE from 'three';
import { WRONG } from './colours';

/**
 * Matte, with a second colour for back faces. One material for both sides, so that there is one mesh to draw and one
 * program to compile, which is slow with software rendering.
 */
export function matte(front: number, back = front): THREE.MeshLambertMaterial {
    const material = new THREE.MeshLambertMaterial({ color: front, side: THREE.DoubleSide, shadowSide: THREE.DoubleSide });
    const colourBehind = { value: new THREE.Color(back) };
    material.onBeforeCompile = (shader) => {
        shader.uniforms.colourBehind = colourBehind;
        shader.fragmentShader = shader.fragmentShader
            .replace('#include <common>', '#include <common>\nuniform vec3 colourBehind;')
            .replace('#include <color_fragment>', '#include <color_fragment>\nif (!gl_FrontFacing) diffuseColor.rgb = colourBehind;');
    };
    return material;
}

/** Marks on faults, seen through everything in front: a face may be smaller than a pixel. Small ones, which do not hide what comes through. @param size  in pixels */
export function glow(geometry = new THREE.BufferGeometry(), size: number, opacity = 1): THREE.Points {
    const points = new THREE.Points(
        geometry,
        new THREE.PointsMaterial({ color: WRONG, size, sizeAttenuation: false, map: spot(), opacity, transparent: true, depthTest: false, depthWrite: false }),
    );
    points.renderOrder = 5;
    points.frustumCulled = false;
    return points;
}

/** White, opaque in the middle. @param softness  of its rim, 0 to 1: 1 fades from the middle on */
export function spot(softness = 1): THREE.DataTexture {
    const side = 64;
    const pixels = new Uint8Array(4 * side * side);
    for (let y = 0; y < side; ++y)
        for (let x = 0; x < side; ++x) {
            const out = Math.hypot((2 * x + 1) / side - 1, (2 * y + 1) / side - 1);
            const share = Math.min(1, Math.max(0, (1 - out) / softness));
            pixels.set([255, 255, 255, 255 * share * share * (3 - 2 * share)], 4 * (y * side + x));
        }
    const texture = new THREE.DataTexture(pixels, side, side);
    texture.magFilter = texture.minFilter = THREE.LinearFilter;
    texture.needsUpdate = true;
    return texture;
}

/** Other numbers, as many as before, for a part of the vertices. */
export function replace(geometry: THREE.BufferGeometry, name: string, array: Float32Array): void {
    const attribute = geometry.attributes[name] as THREE.BufferAttribute;
    attribute.array = array;
    attribute.needsUpdate = true;
}
