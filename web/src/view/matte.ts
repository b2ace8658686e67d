import * as THREE from 'three';

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
