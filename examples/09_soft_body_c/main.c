// Soft bodies in C: an organ of tetrahedra falls into a dish, and a cloth over both; what the dish bears in
// the end is what they weigh. Usage: 09_soft_body_c [TETRAHEDRA]; without a file, a ball that is filled.

#include <echinus/echinus.h>

#include <stdio.h>

#define FRAME_COUNT 60
#define CLOTH_DENSITY 0.125 // kg/m^2
#define MEASURED_COUNT 12

static echinus_status fill_ball(echinus_tetrahedra** organ) {
    echinus_tetrahedralize_options options;
    echinus_mesh* ball = NULL;
    echinus_map* map = NULL;
    echinus_status status = echinus_mesh_sphere(0.08, 60, 30, &ball); // metres, kilograms, seconds
    if (!status) status = echinus_map_build_exact(ball, NULL, &map);
    echinus_tetrahedralize_options_init(&options, sizeof options);
    options.count = 500;
    if (!status) status = echinus_tetrahedralize(map, &options, organ, NULL);
    echinus_map_destroy(map);
    echinus_mesh_destroy(ball);
    return status;
}

static echinus_status make_organ(const echinus_tetrahedra* organ, echinus_deformable** body) {
    echinus_soft_body_options options;
    echinus_soft_body_options_init(&options, sizeof options);
    options.density = 1050;
    options.young_modulus = 5e3;
    options.poisson_ratio = 0.45;
    options.damping = 0.02;
    options.pose.translation[2] = 0.12;
    return echinus_deformable_soft_body(organ, &options, body);
}

static echinus_status make_cloth(echinus_deformable** cloth) {
    echinus_cloth_options options;
    echinus_cloth_options_init(&options, sizeof options);
    options.column_count = options.row_count = 15;
    options.width = options.height = 0.4;
    options.pose.translation[2] = 0.22;
    return echinus_deformable_cloth(&options, cloth);
}

/// A body has its masses itself; a cloth weighs CLOTH_DENSITY for each square metre.
static echinus_status weigh(const echinus_deformable* deformable, double* weight) {
    echinus_deformable_arrays arrays = {.size = sizeof arrays};
    const echinus_status status = echinus_deformable_read(deformable, &arrays);
    *weight = 0;
    for (size_t i = 0; !status && i < arrays.particle_count; ++i) *weight += 9.81 / arrays.inverse_masses[i];
    return status;
}

static echinus_status drop(const echinus_deformable* deformable, const echinus_map* dish, double* borne) {
    echinus_simulation_options options;
    echinus_collider collider;
    echinus_simulation* simulation = NULL;
    echinus_status status;
    echinus_simulation_options_init(&options, sizeof options);
    options.density = CLOTH_DENSITY;
    options.thickness = 0.004;
    echinus_collider_init(&collider, sizeof collider, dish);
    status = echinus_simulation_create(deformable, &collider, 1, &options, &simulation);
    *borne = 0;
    for (int frame = 0; !status && frame < FRAME_COUNT; ++frame) {
        double force[3], torque[3];
        status = echinus_simulation_step(simulation);
        if (!status) status = echinus_simulation_load_on(simulation, 0, force, torque);
        if (!status && frame >= FRAME_COUNT - MEASURED_COUNT) *borne -= force[2] / MEASURED_COUNT;
    }
    echinus_simulation_destroy(simulation);
    return status;
}

int main(int argc, char** argv) {
    echinus_tetrahedra* organ = NULL;
    echinus_tetrahedra_report report = {.size = sizeof report};
    echinus_deformable *body = NULL, *cloth = NULL, *both = NULL;
    echinus_mesh* torus = NULL;
    echinus_map* dish = NULL;
    double weight = 0, borne = 0;
    echinus_status status = argc > 1 ? echinus_tetrahedra_read(argv[1], &organ, NULL) : fill_ball(&organ);

    if (!status) status = echinus_tetrahedra_inspect(organ, &report);
    if (!status) status = make_organ(organ, &body);
    if (!status) status = make_cloth(&cloth);
    if (!status) {
        const echinus_deformable* const parts[2] = {body, cloth};
        status = echinus_deformable_combine(parts, 2, &both);
    }
    if (!status) status = echinus_mesh_torus(0.1, 0.04, 60, 24, &torus);
    if (!status) status = echinus_map_build_exact(torus, NULL, &dish);
    if (!status) status = weigh(body, &weight);
    weight += 9.81 * CLOTH_DENSITY * 0.4 * 0.4;
    if (!status) status = drop(both, dish, &borne);
    if (!status)
        printf("%d tetrahedra with angles from %.0f to %.0f degrees; the dish bears %.0f %% of %.1f N\n",
               (int)report.tetrahedron_count, report.least_angle_deg, report.greatest_angle_deg,
               100 * borne / weight, weight);
    else
        fprintf(stderr, "%s\n", echinus_last_error());

    echinus_map_destroy(dish);
    echinus_mesh_destroy(torus);
    echinus_deformable_destroy(both);
    echinus_deformable_destroy(cloth);
    echinus_deformable_destroy(body);
    echinus_tetrahedra_destroy(organ);
    return status ? 1 : 0;
}
