import { ContactBuffer, type Simulation } from 'echinus';

/**
 * How deep each particle is in the layer of contact, which reaches from the model's surface to twice the thickness, as
 * far as the collision searches for contacts. By the cloth's own map, at the end of a step. 0 and less: no contact;
 * 0.5: at the thickness, where the collision puts it; 1: on the surface; more: inside.
 * @param thickness  the distance that particles keep from the model
 * @param depths     [particles] out
 */
export function measureDepths(simulation: Simulation, thickness: number, contacts: ContactBuffer, depths: Float32Array): void {
    const layer = 2 * thickness;
    simulation.contactsBatch(layer, contacts);
    const { floats } = contacts;
    for (let i = 0; i < depths.length; ++i) {
        const depth = floats[ContactBuffer.STRIDE * i + ContactBuffer.DEPTH]; // of a contact outside: minus its
                                                                              // distance; 0: no contact
        depths[i] = depth === 0 ? 0 : 1 + depth / layer;
    }
}
