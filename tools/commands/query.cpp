#include "commands/commands.hpp"
#include "console/json.hpp"
#include "files/text.hpp"
#include "input_file.hpp"
#include "mesh/local_frame.hpp"
#include "mesh_io/mesh_source.hpp"
#include "output.hpp"
#include "points/points.hpp"

#include <echinus/map_file.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

using namespace echinus;
namespace fs = std::filesystem;

namespace {

struct QueryArguments {
    fs::path map;
    fs::path points;
    fs::path target;
    float margin = 0;
    bool signed_distance = false, winding_number = false;
    bool json = false;
};

struct QuerySummary {
    std::uint64_t point_count = 0;
    std::uint64_t inside_count = 0;
    std::uint64_t contact_count = 0;
    /// The spacing of the points' floats if they are too coarse for the map; otherwise 0.
    double points_step = 0;
};

void require_sound(const QueryArguments& arguments) {
    if (arguments.map == kStandardStream && arguments.points == kStandardStream) {
        throw WrongUse("POINTS", "cannot be standard input as well as MAP");
    }
    if (!(arguments.margin >= 0 && std::isfinite(arguments.margin))) {
        throw WrongUse("--margin", "must be a finite number and not negative");
    }
    require_one_result(arguments.target, arguments.json);
    require_another_file(arguments.map, arguments.target);
    require_another_file(arguments.points, arguments.target);
}

/// The format by the extension of the name; on standard output, the format of the points.
TableFormat format_of_answers(const fs::path& target, TableFormat format_of_points) {
    if (target == kStandardStream) return format_of_points;
    require_ending(target, {".npy", ".csv"});
    return lower_case_ending(target) == ".npy" ? TableFormat::Npy : TableFormat::Csv;
}

void count(std::span<const Contact> contacts, QuerySummary& summary) {
    summary.point_count += contacts.size();
    for (const Contact& contact : contacts) {
        summary.inside_count += contact.inside ? 1 : 0;
        summary.contact_count += contact.found() ? 1 : 0;
    }
}

/// Only an exact map knows the distance from the surface for every point, and how often it goes around it.
void require_exact(const AnyMap& map, const QueryArguments& arguments) {
    if (std::holds_alternative<ExactMap>(map)) return;
    for (const auto& [wanted, name] : {std::pair(arguments.signed_distance, "--signed-distance"),
                                       std::pair(arguments.winding_number, "--winding-number")})
        if (wanted) throw WrongUse(name, "needs an exact map; this one is a distance map");
}

Vec3d origin_of(const AnyMap& map) {
    return std::visit([](const auto& kind) { return kind.view().origin; }, map);
}

/// A map has an origin if floats could not hold its mesh in its place, so they cannot hold points there
/// either.
double points_step(const AnyMap& map, const PointSource& source) {
    if (!source.holds_floats()) return 0;
    const Vec3d origin = origin_of(map);
    return 2 * float_rounding(std::max({std::abs(origin.x), std::abs(origin.y), std::abs(origin.z)}));
}

/// Computes the fields that only exact maps have, one block at a time.
struct ExactAnswers {
    const AnyMap& map;
    std::vector<float> signed_distances, winding_numbers; ///< as large as a block; empty if not requested

    void complete(Answers& answers, StridedSpan<const Vec3f> points) {
        if (!signed_distances.empty()) {
            const std::span<float> results(signed_distances.data(), points.size());
            signed_distance_batch(std::get<ExactMap>(map), points, results);
            answers.signed_distances = results;
        }
        if (!winding_numbers.empty()) {
            const std::span<float> results(winding_numbers.data(), points.size());
            constexpr float kTolerance = 1e-4F;
            winding_number_batch(std::get<ExactMap>(map), points, results, kTolerance);
            answers.winding_numbers = results;
        }
    }
};

QuerySummary answer(const AnyMap& map, const QueryArguments& arguments, PointSource& source,
                    AnswerWriter& answers) {
    constexpr std::size_t kBlock = std::size_t{1} << 16;
    const Vec3d origin = origin_of(map);
    std::vector<Vec3d> points(kBlock);
    std::vector<Vec3f> points_local(kBlock);
    std::vector<Contact> contacts(kBlock);
    ExactAnswers exact{map, std::vector<float>(arguments.signed_distance ? kBlock : 0),
                       std::vector<float>(arguments.winding_number ? kBlock : 0)};
    QuerySummary summary{.points_step = points_step(map, source)};
    while (const std::size_t point_count = source.read(points)) {
        const std::span<Contact> block(contacts.data(), point_count);
        for (std::size_t i = 0; i < point_count; ++i) points_local[i] = to_local(points[i], origin);
        const StridedSpan<const Vec3f> asked(points_local.data(), point_count);
        contacts_batch(map, asked, arguments.margin, block);
        Answers result{.contacts = block};
        exact.complete(result, asked);
        answers.write(result);
        count(block, summary);
    }
    answers.finish();
    return summary;
}

void print_summary(const QuerySummary& summary, const QueryArguments& arguments) {
    if (arguments.json) {
        Json object{{"points", summary.point_count},
                    {"inside", summary.inside_count},
                    {"contacts", summary.contact_count}};
        if (summary.points_step > 0) object.add("points_step", summary.points_step);
        print(object.indented());
    } else if (arguments.target != kStandardStream) {
        print(std::to_string(summary.point_count) + " points, " + std::to_string(summary.inside_count) +
              " inside, " + std::to_string(summary.contact_count) + " with a contact\n");
        if (summary.points_step > 0)
            print("The points are floats, whose spacing is " + number_text(summary.points_step) +
                  " there; pass them as float64 or as text.\n");
    }
}

void query(const QueryArguments& arguments) {
    require_sound(arguments);
    const InputFile map_file(arguments.map, "ech");
    const AnyMap map = map_file.read([](const fs::path& path) { return load_map(path); });
    require_exact(map, arguments);
    auto input = std::make_unique<Input>(arguments.points);
    const TableFormat format = format_of_points(arguments.points, *input);
    const TableFormat answer_format = format_of_answers(arguments.target, format);
    const auto source =
        format == TableFormat::Npy ? open_npy_points(std::move(input)) : open_csv_points(std::move(input));
    const auto answers = open_answers(arguments.target, answer_format, source->count(),
                                      {.signed_distance = arguments.signed_distance,
                                       .winding_number = arguments.winding_number,
                                       .origin = origin_of(map)});
    print_summary(answer(map, arguments, *source, *answers), arguments);
}

} // namespace

void add_query_command(Command program) {
    Command command = program.add_command(
        "query", "Query a map for points: inside or outside, depth, nearest surface point");
    const auto arguments = std::make_shared<QueryArguments>();
    command.add("MAP", &arguments->map, "Map file, or -").required().type_name("");
    command.add("POINTS", &arguments->points, "Points: an array [n, 3] as .npy, or lines x,y,z as .csv, or -")
        .required()
        .type_name("");
    command.add("-o,--output", &arguments->target, "Answers to write, .npy or .csv, or -")
        .required()
        .type_name("ANSWERS");
    command
        .add("--margin", &arguments->margin,
             "Points outside also get a contact if they are at most this far from the surface, in "
             "the unit of the mesh; with a distance map this is measured along their ray from the centre")
        .type_name("DISTANCE")
        .show_default();
    command.add_flag("--signed-distance", arguments->signed_distance,
                     "Add the signed distance of every point, negative inside (exact maps)");
    command.add_flag("--winding-number", arguments->winding_number,
                     "Add the generalised winding number of every point, accurate to 0.0001; it is not an "
                     "integer for an open surface (exact maps)");
    command.add_flag("--json", arguments->json, "Print one JSON object");
    command.footer("Example:\n  echinus query torus.ech points.npy -o answers.npy");
    command.action([arguments] { query(*arguments); });
}
