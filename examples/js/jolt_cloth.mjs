// A world of Jolt, and a cloth in it. Nothing here is about Echinus.

export const MODELS = 0, CLOTHS = 1; // layers

/** @param doMeet  whether Jolt itself keeps cloth off models */
export function makeWorld(Jolt, gravity, { doMeet = false } = {}) {
    const pairs = new Jolt.ObjectLayerPairFilterTable(2);
    if (doMeet) pairs.EnableCollision(MODELS, CLOTHS);
    const layers = new Jolt.BroadPhaseLayerInterfaceTable(2, 2);
    for (const layer of [MODELS, CLOTHS]) layers.MapObjectToBroadPhaseLayer(layer, new Jolt.BroadPhaseLayer(layer));
    const settings = new Jolt.JoltSettings();
    settings.mObjectLayerPairFilter = pairs;
    settings.mBroadPhaseLayerInterface = layers;
    settings.mObjectVsBroadPhaseLayerFilter = new Jolt.ObjectVsBroadPhaseLayerFilterTable(layers, 2, pairs, 2);
    const jolt = new Jolt.JoltInterface(settings);
    jolt.GetPhysicsSystem().SetGravity(new Jolt.Vec3(...gravity));
    return { jolt, bodies: jolt.GetPhysicsSystem().GetBodyInterface() };
}

/** A square grid in the plane z = 0. */
export function makeSheet(columns, size) {
    const vertices = [], faces = [];
    for (let row = 0; row < columns; ++row)
        for (let column = 0; column < columns; ++column) {
            vertices.push(size * (column / (columns - 1) - 0.5), size * (row / (columns - 1) - 0.5), 0);
            if (row + 1 === columns || column + 1 === columns) continue;
            const a = row * columns + column, b = a + 1, c = a + columns, d = c + 1;
            faces.push(a, b, d, a, d, c);
        }
    return { vertices, faces };
}

/**
 * A soft body of a mesh, each of whose vertices weighs 1.
 * @param pins    vertices that do not move
 * @param change  of the SoftBodyCreationSettings
 */
export function addCloth(Jolt, bodies, { vertices, faces }, { position = [0, 0, 0], pins = [], compliance = 1e-5, change = () => {} } = {}) {
    const count = vertices.length / 3;
    const shared = new Jolt.SoftBodySharedSettings();
    const vertex = new Jolt.SoftBodySharedSettingsVertex();
    for (let i = 0; i < count; ++i) {
        [vertex.mPosition.x, vertex.mPosition.y, vertex.mPosition.z] = vertices.slice(3 * i, 3 * i + 3);
        vertex.mInvMass = pins.includes(i) ? 0 : 1;
        shared.mVertices.push_back(vertex);
    }
    const face = new Jolt.SoftBodySharedSettingsFace(0, 0, 0, 0);
    for (let i = 0; i < faces.length; i += 3) {
        for (let k = 0; k < 3; ++k) face.set_mVertex(k, faces[i + k]);
        shared.AddFace(face);
    }
    const attributes = new Jolt.SoftBodySharedSettingsVertexAttributes();
    attributes.mCompliance = attributes.mShearCompliance = attributes.mBendCompliance = compliance;
    shared.CreateConstraints(attributes, 1, Jolt.SoftBodySharedSettings_EBendType_Distance);
    shared.Optimize();
    const settings = new Jolt.SoftBodyCreationSettings(shared, new Jolt.RVec3(...position), new Jolt.Quat(0, 0, 0, 1), CLOTHS);
    change(settings);
    const body = bodies.CreateSoftBody(settings);
    bodies.AddBody(body.GetID(), Jolt.EActivation_Activate);
    return body;
}

/** [3 vertex_count] in the world. */
export function positionsOf(Jolt, body) {
    const vertices = Jolt.castObject(body.GetMotionProperties(), Jolt.SoftBodyMotionProperties).GetVertices();
    const centre = body.GetPosition();
    const [x, y, z] = [centre.GetX(), centre.GetY(), centre.GetZ()];
    const positions = new Float32Array(3 * vertices.size());
    for (let i = 0; i < vertices.size(); ++i) {
        const place = vertices.at(i).mPosition;
        positions.set([place.GetX() + x, place.GetY() + y, place.GetZ() + z], 3 * i);
    }
    return positions;
}
