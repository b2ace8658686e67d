import * as THREE from 'three';

/** Samples around each pixel, and how far from it they reach, in radii of what is in sight. */
const SAMPLES = 12, REACH = 0.22;

/**
 * Draws a scene with the corners darkened that little light gets into: where cloth lies on the model, in folds, under feet. From the depths
 * in the picture alone: McGuire, Mara and Luebke, "Scalable Ambient Obscurance" (2012), with fewer samples and one blur.
 */
export class ContactShading {
    readonly #picture = new THREE.WebGLRenderTarget(1, 1, { samples: 4, type: THREE.HalfFloatType, depthTexture: new THREE.DepthTexture(1, 1, THREE.UnsignedIntType) });
    readonly #corners = new THREE.WebGLRenderTarget(1, 1, { depthBuffer: false });
    readonly #quad = new THREE.Mesh(new THREE.PlaneGeometry(2, 2));
    readonly #camera = new THREE.OrthographicCamera(-1, 1, 1, -1, 0, 1);
    readonly #uniforms = {
        depths: { value: this.#picture.depthTexture },
        picture: { value: this.#picture.texture },
        corners: { value: this.#corners.texture },
        unproject: { value: new THREE.Matrix4() },
        project: { value: new THREE.Matrix4() },
        texel: { value: new THREE.Vector2() },
        reach: { value: 1 },
    };
    readonly #obscure = this.#pass(OBSCURE);
    readonly #compose = this.#pass(COMPOSE);

    #pass(fragmentShader: string): THREE.ShaderMaterial {
        return new THREE.ShaderMaterial({ vertexShader: PLACE, fragmentShader, uniforms: this.#uniforms, depthTest: false, depthWrite: false });
    }

    /** Into the present viewport of the canvas. @param size  of it, in pixels */
    render(renderer: THREE.WebGLRenderer, scene: THREE.Scene, camera: THREE.PerspectiveCamera, size: THREE.Vector2, radius: number): void {
        const [width, height] = [Math.max(1, Math.round(size.x)), Math.max(1, Math.round(size.y))];
        if (this.#picture.width !== width || this.#picture.height !== height) {
            this.#picture.setSize(width, height);
            this.#corners.setSize(Math.ceil(width / 2), Math.ceil(height / 2));
        }
        this.#uniforms.texel.value.set(1 / this.#corners.width, 1 / this.#corners.height);
        this.#uniforms.reach.value = REACH * radius;
        renderer.setRenderTarget(this.#picture);
        renderer.render(scene, camera);
        this.#uniforms.project.value.copy(camera.projectionMatrix);
        this.#uniforms.unproject.value.copy(camera.projectionMatrixInverse);
        this.#draw(renderer, this.#obscure, this.#corners);
        this.#draw(renderer, this.#compose, null);
    }

    #draw(renderer: THREE.WebGLRenderer, material: THREE.ShaderMaterial, target: THREE.WebGLRenderTarget | null): void {
        this.#quad.material = material;
        renderer.setRenderTarget(target);
        const { enabled } = renderer.shadowMap;
        renderer.shadowMap.enabled = false;
        renderer.render(this.#quad, this.#camera);
        renderer.shadowMap.enabled = enabled;
    }

    dispose(): void {
        for (const thing of [this.#picture, this.#corners, this.#obscure, this.#compose, this.#quad.geometry]) thing.dispose();
    }
}

const PLACE = `
    varying vec2 place;
    void main() {
        place = uv;
        gl_Position = vec4(position.xy, 0.0, 1.0);
    }`;

const DEPTHS = `
    varying vec2 place;
    uniform sampler2D depths;
    uniform mat4 project, unproject;
    uniform vec2 texel;
    uniform float reach;
    vec3 seenAt(vec2 at) {
        vec4 p = unproject * vec4(2.0 * vec3(at, texture2D(depths, at).r) - 1.0, 1.0);
        return p.xyz / p.w;
    }`;

const OBSCURE = `
    ${DEPTHS}
    void main() {
        if (texture2D(depths, place).r >= 1.0) {
            gl_FragColor = vec4(1.0);
            return;
        }
        vec3 here = seenAt(place);
        // The nearer neighbour on each axis lies on the same surface.
        vec3 right = seenAt(place + vec2(texel.x, 0.0)) - here, left = here - seenAt(place - vec2(texel.x, 0.0));
        vec3 above = seenAt(place + vec2(0.0, texel.y)) - here, below = here - seenAt(place - vec2(0.0, texel.y));
        vec3 normal = normalize(cross(abs(right.z) < abs(left.z) ? right : left, abs(above.z) < abs(below.z) ? above : below));
        float turn = 6.2832 * fract(52.9829 * fract(dot(gl_FragCoord.xy, vec2(0.06711, 0.00584))));
        vec2 wide = 0.5 * reach * vec2(project[0][0], project[1][1]) / -here.z;
        float dark = 0.0;
        for (int i = 0; i < ${SAMPLES}; ++i) {
            float share = (float(i) + 0.5) / ${SAMPLES}.0;
            float angle = turn + 2.39996 * float(i);
            vec3 way = seenAt(place + share * wide * vec2(cos(angle), sin(angle))) - here;
            float square = dot(way, way);
            float near = max(0.0, 1.0 - square / (reach * reach));
            dark += near * near * max(0.0, dot(way, normal) - 0.03 * reach - 0.0015 * abs(here.z)) / (sqrt(square) + 0.01 * reach);
        }
        gl_FragColor = vec4(vec3(max(0.0, 1.0 - 1.9 * dark / ${SAMPLES}.0)), 1.0);
    }`;

const COMPOSE = `
    ${DEPTHS}
    uniform sampler2D picture, corners;
    void main() {
        float own = seenAt(place).z, sum = 0.0, weights = 1e-4;
        for (int y = -2; y <= 1; ++y)
            for (int x = -2; x <= 1; ++x) {
                vec2 at = place + texel * (vec2(x, y) + 0.5);
                float weight = exp(-abs(seenAt(at).z - own) / (0.06 * reach));
                sum += weight * texture2D(corners, at).r;
                weights += weight;
            }
        float open = weights > 1e-3 ? sum / weights : 1.0;
        vec4 seen = texture2D(picture, place);
        // The light in a corner comes from warm surfaces.
        gl_FragColor = vec4(seen.rgb * mix(vec3(0.16, 0.12, 0.11), vec3(1.0), open), 1.0);
        #include <colorspace_fragment>
    }`;
