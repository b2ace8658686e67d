import { type ExactMap, type Contact, load } from 'echinus';
import { JoltCollision } from 'echinus/jolt';
import { RapierCollision } from 'echinus/rapier';
import { ClothGeometry, meshOfGeometry } from 'echinus/three';
import type Jolt from 'jolt-physics';
import type { SoftBody } from '@dimforge/rapier3d-compat';
import { BoxGeometry } from 'three';

export async function user(jolt: typeof Jolt, body: Jolt.Body, softBody: SoftBody): Promise<number> {
    const echinus = await load();
    using mesh = meshOfGeometry(echinus, new BoxGeometry());
    const map: ExactMap = echinus.buildMap(mesh);
    const contact: Contact = map.contact([0, 0, 0]);
    // @ts-expect-error: a word that is none of the three
    mesh.repair(['everything']);
    const simulation = echinus.parseScene({ model: 'box', cloth: { size: [1, 1] } }).makeSimulation(map);
    new ClothGeometry(simulation).update();
    simulation.setColliderVertices(mesh.vertices);
    // @ts-expect-error: an array of numbers has to become a Float32Array
    simulation.setColliderVertices([0, 0, 0], 0);
    using inJolt = new JoltCollision(echinus, jolt, body, { colliders: [{ map, body }], thickness: 0.01 });
    // @ts-expect-error: the thickness is needed
    new RapierCollision(echinus, softBody, { colliders: [{ map }] });
    return inJolt.step(1 / 60) + contact.depth;
}
