// A cloth of Echinus on a knot of three.js, as objects for a scene. three.mjs counts, three.html draws.
import { DoubleSide, Mesh, MeshStandardMaterial, TorusKnotGeometry } from 'three';
import { ClothGeometry, meshOfGeometry } from 'echinus/three';

export function clothOnKnot(echinus) {
    const knot = new Mesh(new TorusKnotGeometry(1, 0.32, 160, 24), new MeshStandardMaterial({ color: 0x8d99ae, roughness: 0.5 }));
    knot.rotation.x = -Math.PI / 2;
    knot.updateMatrixWorld();
    const model = meshOfGeometry(echinus, knot.geometry, knot.matrixWorld);
    const map = echinus.buildMap(model);
    const scene = echinus.parseScene({
        model: 'the knot', // its map is there already
        cloth: { size: [3.6, 3.6], particles: [40, 40], position: [0, 0.9, 0], rotation: { axis: [1, 0, 0], degrees: -90 }, thickness: 0.015 },
        gravity: [0, -9.81, 0],
    });
    const simulation = scene.makeSimulation(map);
    const material = new MeshStandardMaterial({ color: 0xd8572a, roughness: 0.8, side: DoubleSide });
    const cloth = new Mesh(new ClothGeometry(simulation), material);
    return {
        knot, cloth, model, simulation,
        /** A sixtieth of a second. */
        step() {
            simulation.step();
            cloth.geometry.update();
        },
    };
}
