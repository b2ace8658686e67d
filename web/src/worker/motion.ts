import type { ColliderState } from 'echinus';
import type { Triple } from '../protocol';
import type { Settings } from '../settings';

const TURN = Math.PI / 5; // radians per second: once around in ten seconds
const SWING = { radians: 0.35, seconds: 4 };

/**
 * The model's velocities at a time: it turns about its centre, wherever its origin is.
 * @param up  unit
 */
export function motionAt(
    motion: Settings['motion'],
    up: Triple,
    seconds: number,
    centre: readonly number[],
    collider: ColliderState,
): { linear: Triple; angular: Triple } {
    const angular = angularVelocity(motion, up, seconds);
    const arm = rotated(collider.rotation, centre);
    const [x, y, z] = cross(angular, arm);
    return { linear: [-x, -y, -z], angular };
}

function angularVelocity(motion: Settings['motion'], up: Triple, seconds: number): Triple {
    switch (motion) {
        case 'still':
            return [0, 0, 0];
        case 'turning':
            return up.map((part) => TURN * part) as Triple;
        case 'swinging': {
            const rate = (2 * Math.PI) / SWING.seconds;
            const speed = SWING.radians * rate * Math.cos(rate * seconds);
            // About the axis after up: across the horse's length.
            return [up[2], up[0], up[1]].map((part) => speed * part) as Triple;
        }
    }
}

function rotated([w, x, y, z]: ColliderState['rotation'], v: readonly number[]): Triple {
    const axis: Triple = [x, y, z];
    const t = cross(axis, v).map((part) => 2 * part);
    const u = cross(axis, t);
    return [0, 1, 2].map((k) => v[k] + w * t[k] + u[k]) as Triple;
}

function cross(a: readonly number[], b: readonly number[]): Triple {
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
}
