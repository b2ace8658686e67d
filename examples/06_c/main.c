// Echinus in C: a map, a batch of points that lie in the caller's own structs, and a cloth that falls.
// Usage: 06_c [MESH]; without a file, a torus.

#include <echinus/echinus.h>

#include <stdint.h>
#include <stdio.h>

typedef struct { // as an engine might have it
    float u, v;
    float position[3];
    uint32_t colour;
} vertex;

#define VERTEX_COUNT 3

static int ask(const echinus_map* map) {
    const vertex vertices[VERTEX_COUNT] = {
        {0, 0, {1.3F, 0.1F, 0.1F}, 0}, {0, 0, {0.3F, 0.9F, 0.3F}, 0}, {0, 0, {0, 0, 0}, 0}};
    echinus_contact contacts[VERTEX_COUNT];
    if (echinus_map_contacts(map, vertices[0].position, VERTEX_COUNT, sizeof(vertex), 0, 1, contacts))
        return 0;
    for (int i = 0; i < VERTEX_COUNT; ++i) {
        const echinus_contact* c = &contacts[i];
        if (c->inside)
            printf("inside, %.2f deep; the nearest point of the surface is (%.2f, %.2f, %.2f)\n", c->depth,
                   c->point[0], c->point[1], c->point[2]);
        else
            printf("outside\n");
    }
    return 1;
}

static int drop_cloth(const echinus_map* map) {
    echinus_deformable* cloth = NULL;
    echinus_simulation* simulation = NULL;
    echinus_cloth_options sheet;
    echinus_collider collider;
    echinus_simulation_profile profile = {.size = sizeof profile};
    int done = 0;

    echinus_cloth_options_init(&sheet, sizeof sheet);
    sheet.column_count = sheet.row_count = 20;
    sheet.width = sheet.height = 3;
    sheet.pose.translation[2] = 0.5;
    echinus_collider_init(&collider, sizeof collider, map);

    if (echinus_deformable_cloth(&sheet, &cloth)) goto end;
    if (echinus_simulation_create(cloth, &collider, 1, NULL, &simulation)) goto end;
    for (int frame = 0; frame < 200; ++frame)
        if (echinus_simulation_step(simulation)) goto end;
    if (echinus_simulation_read_profile(simulation, &profile)) goto end;
    printf("after 200 frames particle 0 is at height %.2f; %d particles were lost\n",
           echinus_simulation_positions(simulation)[2], (int)profile.lost_count);
    done = 1;

end: // destroying NULL does nothing
    echinus_simulation_destroy(simulation);
    echinus_deformable_destroy(cloth);
    return done;
}

int main(int argc, char** argv) {
    echinus_mesh* mesh = NULL;
    echinus_map* map = NULL;
    const echinus_status read =
        argc > 1 ? echinus_mesh_read(argv[1], &mesh) : echinus_mesh_torus(1.0, 0.4, 60, 24, &mesh);
    const int done = !read && !echinus_map_build_exact(mesh, NULL, &map) && ask(map) && drop_cloth(map);

    if (!done) fprintf(stderr, "%s\n", echinus_last_error());
    echinus_map_destroy(map);
    echinus_mesh_destroy(mesh);
    return done ? 0 : 1;
}
