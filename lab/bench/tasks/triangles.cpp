// The task triangles: the faces of a cloth at rest against the model that it lies on.

#include "compare/turns.hpp"
#include "systems.hpp"
#include "task.hpp"

#include <echinus/intersections.hpp>
#include <echinus/mesh_io.hpp>
#include <echinus/surface_queries.hpp>
#include <echinus_scene/scene.hpp>

#include <fmt/format.h>

#include <algorithm>

using namespace echinus;
using namespace echinus::comparison;
using namespace echinus::rivals;

namespace {

/// A model and a cloth that came to rest on it.
struct RestingCloth {
    TriangleMesh model, cloth;
    double thickness;
};

RestingCloth drape(const Setting& setting) {
    Scene scene = read_scene(setting.scenes / "horse.json");
    if (setting.is_short) scene.cloth.column_count = scene.cloth.row_count = 30;
    scene.simulation.solver = JakobsenOptions{};
    scene.simulation.time_step = 1.0 / 240;
    TriangleMesh model = repair(read_mesh(setting.debian_horse), scene.colliders.front().repair).mesh;
    Simulation simulation = make_simulation(scene, ExactMap::build(model));
    while (!simulation.at_rest() && simulation.frame() < scene.frame_limit) simulation.step();
    const Deformable& cloth = simulation.deformable();
    return {std::move(model), {cloth.positions, cloth.faces}, simulation.options().thickness.value()};
}

/// A system that answers for all faces of the cloth in one call, and what it found in the last.
struct Contestant {
    std::string system, question;
    std::function<std::size_t()> find;
    std::size_t found = 0;
};

TrianglePoints corners_of(const TriangleMesh& mesh, const Triangle& face) {
    return {mesh.vertices[face[0]], mesh.vertices[face[1]], mesh.vertices[face[2]]};
}

std::vector<Contestant> contestants(const RestingCloth& scene, const ExactMap& map,
                                    const std::vector<NamedTriangleRival>& rivals,
                                    const EmbreeTriangles& embree) {
    const TriangleMesh& cloth = scene.cloth;
    // Wherever a face may touch within two thicknesses.
    const auto reach = static_cast<float>(2 * scene.thickness);
    std::vector<Contestant> all;
    all.push_back({"exact map", "faces that intersect", [&] {
                       return static_cast<std::size_t>(
                           std::count_if(cloth.faces.begin(), cloth.faces.end(), [&](const Triangle& face) {
                               return intersects(map.view(), corners_of(cloth, face));
                           }));
                   }});
    all.push_back({"two box trees", "faces that intersect", [&] {
                       std::vector<std::uint32_t> faces;
                       for (const FacePair& pair : intersecting_pairs(cloth, scene.model))
                           if (faces.empty() || faces.back() != pair.a) faces.push_back(pair.a);
                       return faces.size();
                   }});
    for (const NamedTriangleRival& rival : rivals)
        all.push_back({rival.name, "faces that intersect", [&] {
                           std::vector<std::uint8_t> meets(cloth.faces.size());
                           rival.system->find_intersecting(cloth, meets);
                           return static_cast<std::size_t>(std::count(meets.begin(), meets.end(), 1));
                       }});
    all.push_back({"exact map", "pairs within reach", [&, reach, lists = FaceLists{}]() mutable {
                       faces_within_batch(map.view(), cloth.vertices, cloth.faces, reach, lists);
                       return lists.faces.size();
                   }});
    all.push_back({"Embree, boxes only", "pairs within reach",
                   [&, reach] { return embree.count_near_boxes(cloth, reach); }});
    all.push_back({"exact map", "faces with a clearance within reach", [&, reach] {
                       return static_cast<std::size_t>(
                           std::count_if(cloth.faces.begin(), cloth.faces.end(), [&](const Triangle& face) {
                               return clearance(map.view(), corners_of(cloth, face), reach).found();
                           }));
                   }});
    return all;
}

} // namespace

Records measure_triangles(const Setting& setting) {
    setting.report_progress("the cloth comes to rest", 0);
    const RestingCloth scene = drape(setting);
    const ExactMap map = ExactMap::build(scene.model);
    const std::vector<NamedTriangleRival> rivals = triangle_rivals(scene.model);
    const EmbreeTriangles embree(scene.model);
    std::vector<Contestant> all = contestants(scene, map, rivals, embree);
    std::vector<Racer> racers;
    for (Contestant& contestant : all)
        racers.push_back({[&contestant](Part) { contestant.found = contestant.find(); }, {{0, 1}}});
    const std::vector<Pace> paces =
        take_turns(racers, {.passes = 3 * setting.effort.passes, .report_progress = [&](double fraction) {
                                setting.report_progress("triangles", fraction);
                            }});
    Records records({"question", "system", "faces", "model_faces", "ms", "spread", "found"});
    for (std::size_t k = 0; k < all.size(); ++k)
        records.add({{"question", all[k].question},
                     {"system", all[k].system},
                     {"faces", fmt::format("{}", scene.cloth.faces.size())},
                     {"model_faces", fmt::format("{}", scene.model.faces.size())},
                     {"ms", fmt::format("{:.4g}", 1e-6 * paces[k].ns)},
                     {"spread", fmt::format("{:.2g}", paces[k].spread)},
                     {"found", fmt::format("{}", all[k].found)}});
    return records;
}
