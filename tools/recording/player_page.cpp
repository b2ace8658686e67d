#include "recording/player_page.hpp"

#include "console/machine.hpp"
#include "files/read_file.hpp"
#include "files/system.hpp"
#include "recording/recording.hpp"
#include "recording/threads.hpp"

#include <echinus/error.hpp>

#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <new>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

using namespace echinus;
namespace fs = std::filesystem;

namespace {

// ---- Bytes in a document ----

/// Compresses bytes as they are added, in the zlib format (RFC 1950), which browsers call "deflate".
///
/// Looks for runs of equal bytes only: differences between frames have few other repetitions, and it takes a
/// quarter of the time (10 000 particles for 659 frames: 0.6 s and 7.21 MB; with all matches 2.2 s, 7.33 MB).
class Deflater {
  public:
    Deflater();
    Deflater(const Deflater&) = delete;
    Deflater& operator=(const Deflater&) = delete;
    ~Deflater();

    void add(std::span<const std::uint8_t> bytes);
    /// All added bytes, compressed. Call once, at the end.
    std::vector<std::uint8_t> finish();

  private:
    void run(int flush);

    z_stream stream_{};
    std::vector<std::uint8_t> compressed_;
};

Deflater::Deflater() {
    constexpr int kWindowBits = 15, kMemoryLevel = 9;
    // The arguments are constants, so only memory can fail.
    if (deflateInit2(&stream_, Z_DEFAULT_COMPRESSION, Z_DEFLATED, kWindowBits, kMemoryLevel, Z_RLE) != Z_OK)
        throw std::bad_alloc();
}

Deflater::~Deflater() {
    deflateEnd(&stream_);
}

void Deflater::add(std::span<const std::uint8_t> bytes) {
    while (!bytes.empty()) {
        const std::size_t count = std::min<std::size_t>(bytes.size(), std::numeric_limits<uInt>::max());
        stream_.next_in = const_cast<std::uint8_t*>(bytes.data()); // zlib only reads
        stream_.avail_in = static_cast<uInt>(count);
        run(Z_NO_FLUSH);
        bytes = bytes.subspan(count);
    }
}

std::vector<std::uint8_t> Deflater::finish() {
    run(Z_FINISH);
    return std::move(compressed_);
}

void Deflater::run(int flush) {
    std::array<std::uint8_t, 1 << 16> buffer;
    do {
        stream_.next_out = buffer.data();
        stream_.avail_out = static_cast<uInt>(buffer.size());
        deflate(&stream_, flush);
        compressed_.insert(compressed_.end(), buffer.data(), stream_.next_out);
    } while (stream_.avail_out == 0);
}

/// Bytes as text for an HTML document: RFC 4648, section 4.
std::string base64(std::span<const std::uint8_t> bytes) {
    constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
        std::uint32_t group = 0;
        for (std::size_t k = 0; k < 3; ++k) group = group << 8U | (k < count ? bytes[i + k] : 0U);
        for (std::size_t k = 0; k < 4; ++k) text += k <= count ? kDigits[group >> (18 - 6 * k) & 63U] : '=';
    }
    return text;
}

// ---- The code of positions ----

/// How a page holds the positions of a recording (docs/command_line.md has the whole format). Positions are
/// rounded to a lattice; a coordinate is a whole number of its steps, of which the page keeps 16 bits; the
/// rest follows from the frame's origin, since no frame is larger than 2^16 - 1 steps.
struct Lattice {
    double step; ///< in the scene's unit; a coordinate is inexact by at most half of it and the rounding to
                 ///< float

    std::int64_t index_of(float coordinate) const;
};

std::array<float, 3> coordinates(const Vec3f& point) {
    return {point.x, point.y, point.z};
}

struct Range {
    float least = std::numeric_limits<float>::infinity();
    float greatest = -least;
};

/// The range of a frame's coordinates along one axis.
Range range_of(const RecordedFrame& frame, std::size_t axis) {
    Range range;
    for (const Vec3f& position : frame.positions) {
        const float coordinate = coordinates(position)[axis];
        range.least = std::min(range.least, coordinate);
        range.greatest = std::max(range.greatest, coordinate);
    }
    return range;
}

using Coordinates = std::vector<std::uint16_t>;

/// The coordinates of a frame in steps, axis by axis, modulo 2^16.
Coordinates coordinates_of(const RecordedFrame& frame, const Lattice& lattice) {
    Coordinates result;
    result.reserve(3 * frame.positions.size());
    for (std::size_t axis = 0; axis < 3; ++axis)
        for (const Vec3f& position : frame.positions)
            result.push_back(static_cast<std::uint16_t>(lattice.index_of(coordinates(position)[axis])));
    return result;
}

/// Maps 0, -1, 1, -2 ... to 0, 1, 2, 3 ...
std::uint16_t folded(std::uint16_t difference) {
    const bool negative = (difference & 0x8000U) != 0;
    return static_cast<std::uint16_t>(difference << 1U ^ (negative ? 0xffffU : 0U));
}

std::int64_t Lattice::index_of(float coordinate) const {
    return std::llround(coordinate / step);
}

/// The finest lattice into which each frame fits: the step is 1 / 65534 of the largest extent of any frame
/// along any axis.
Lattice lattice_of(std::span<const RecordedFrame> frames) {
    constexpr double kSteps = 65534; // rounding at both ends may add one more
    constexpr double kMostIndex = 1LL << 50U;
    double extent = 0, farthest = 0;
    for (const RecordedFrame& frame : frames) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const Range range = range_of(frame, axis);
            extent = std::max(extent, double{range.greatest} - double{range.least});
            farthest = std::max({farthest, std::abs(double{range.least}), std::abs(double{range.greatest})});
        }
    }
    // For a small cloth that is far away, coordinates in steps must not exceed what a browser's numbers can
    // represent.
    const double step = std::max(extent / kSteps, farthest / kMostIndex);
    return {step > 0 ? step : 1};
}

/// The smallest coordinates of a frame's particles, in steps.
std::array<std::int64_t, 3> origin_of(const RecordedFrame& frame, const Lattice& lattice) {
    std::array<std::int64_t, 3> origin;
    for (std::size_t axis = 0; axis < 3; ++axis) origin[axis] = lattice.index_of(range_of(frame, axis).least);
    return origin;
}

/// Adds each frame's coordinates as their second differences in time, modulo 2^16: the deviation from uniform
/// motion. Axis by axis; small differences of either sign become small numbers (0, -1, 1, -2 ... as 0, 1, 2,
/// 3 ...), of which first all low bytes are written and then all high ones, mostly zero.
void add_motion(Deflater& deflater, std::span<const RecordedFrame> frames, const Lattice& lattice) {
    if (frames.empty()) return;
    const std::size_t count = 3 * frames.front().positions.size();
    Coordinates before(count, 0), last(count, 0);
    std::vector<std::uint8_t> bytes(2 * count);
    for (const RecordedFrame& frame : frames) {
        Coordinates now = coordinates_of(frame, lattice);
        for (std::size_t i = 0; i < count; ++i) {
            const std::uint16_t code = folded(static_cast<std::uint16_t>(now[i] - 2U * last[i] + before[i]));
            bytes[i] = static_cast<std::uint8_t>(code);
            bytes[count + i] = static_cast<std::uint8_t>(code >> 8U);
        }
        deflater.add(bytes);
        before = std::move(last);
        last = std::move(now);
    }
}

// ---- The player ----

constexpr std::string_view kPlace = "<!-- recording -->";

/// The player's path relative to the program, so that an installation may be moved.
fs::path installed_player() {
    return (system::program_path().parent_path() / ECHINUS_DATA_FOLDER / "player.html").lexically_normal();
}

std::string read_text(const fs::path& path) {
    const std::vector<std::byte> bytes = read_file(path);
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

std::string read_player(const fs::path& path) {
    try {
        return read_text(path);
    } catch (const Error& error) {
        throw Error(ErrorCode::Unreadable,
                    std::string(error.what()) +
                        "; --html needs the player: build it with scripts/web --build-only (and install "
                        "again, for an installed program), or name one with --player");
    }
}

// ---- Its contents ----

/// The format numbers of a recording with one collider, and with several.
constexpr int kFormat = 1, kFormatOfSeveral = 2;
static_assert(std::endian::native == std::endian::little, "shapes are written as they lie in memory");

Json to_json(const Vec3d& v) {
    return {v.x, v.y, v.z};
}

Json to_json(const RigidTransform& pose) {
    const Rotation& q = pose.rotation;
    return {{"position", to_json(pose.translation)}, {"rotation", {q.w, q.x, q.y, q.z}}};
}

/// The part of report.json that a page shows.
Json figures_of(const SimulationResult& result) {
    return ::to_json(result).part({"particles", "constraints", "solver", "iterations", "time_step", "frames",
                                   "frames_to_rest", "ms_per_frame", "queries_per_frame", "ns_per_query",
                                   "map_kind", "thickness", "gravity"});
}

Json to_json(const std::vector<RigidTransform>& poses) {
    Json list = Json::array();
    for (const RigidTransform& pose : poses) list.push_back(to_json(pose));
    return list;
}

Json frames_of(const Recording& recording, const Lattice& lattice, bool moves) {
    Json frames = Json::array();
    for (const RecordedFrame& frame : recording.frames()) {
        Json entry{
            {"number", frame.number}, {"inside", frame.inside_count}, {"origin", origin_of(frame, lattice)}};
        if (frame.pairs) {
            entry.add("intersecting_pairs", frame.pairs->with_models);
            entry.add("self_intersecting_pairs", frame.pairs->own);
        }
        if (moves || &frame == &recording.frames().front()) {
            if (frame.poses.size() == 1)
                entry.add("pose", to_json(frame.poses.front()));
            else
                entry.add("poses", to_json(frame.poses));
        }
        frames.push_back(std::move(entry));
    }
    return frames;
}

/// The bounding sphere of all colliders in their initial poses.
Sphere sphere_of(const PlayedSimulation& played) {
    if (played.colliders.size() == 1) return inspect(played.colliders.front()).bounding_sphere;
    TriangleMesh all;
    for (std::size_t c = 0; c < played.colliders.size(); ++c)
        for (const Vec3f& vertex : played.colliders[c].vertices)
            all.vertices.emplace_back(played.recording.frames().front().poses[c].to_world(Vec3d(vertex)));
    all.faces.push_back({0, 1, 2});
    return inspect(all).bounding_sphere;
}

/// How many vertices and faces each collider has.
Json parts_of(std::span<const TriangleMesh> colliders) {
    Json parts = Json::array();
    for (const TriangleMesh& mesh : colliders)
        parts.push_back({{"vertices", mesh.vertices.size()}, {"faces", mesh.faces.size()}});
    return parts;
}

Json description_of(const PlayedSimulation& played, const Lattice& lattice) {
    const Simulation& simulation = played.result.simulation;
    const Sphere sphere = sphere_of(played);
    std::size_t vertex_count = 0, face_count = 0;
    for (const TriangleMesh& mesh : played.colliders) {
        vertex_count += mesh.vertices.size();
        face_count += mesh.faces.size();
    }
    const bool moves = std::any_of(played.result.colliders.begin(), played.result.colliders.end(),
                                   [](const ColliderResult& collider) { return collider.poses.size() > 1; });
    Json model{{"name", played.model_name}, {"notice", played.notice},          {"vertices", vertex_count},
               {"faces", face_count},       {"centre", to_json(sphere.centre)}, {"radius", sphere.radius}};
    if (played.colliders.size() > 1) model.add("parts", parts_of(played.colliders));
    return {
        {"format", played.colliders.size() == 1 ? kFormat : kFormatOfSeveral},
        {"version", ECHINUS_VERSION},
        {"machine", describe_machine()},
        {"scene", played.scene_name},
        {"model", std::move(model)},
        {"cloth_faces", surface_of(simulation.deformable()).size()},
        {"lattice_step", lattice.step},
        {"figures", figures_of(played.result)},
        {"frames", frames_of(played.recording, lattice, moves)},
    };
}

/// JSON that may stand in an HTML script element: no name in it can end the element or begin a comment.
std::string in_script(const Json& object) {
    std::string text;
    // File names and notices need not be UTF-8; JSON must be.
    for (const char c : object.one_line()) c == '<' ? text += "\\u003c" : text += c;
    return text;
}

template <typename T>
std::span<const std::uint8_t> bytes_of(const std::vector<T>& values) {
    return {reinterpret_cast<const std::uint8_t*>(values.data()), values.size() * sizeof(T)};
}

std::vector<std::uint8_t> compressed(const PlayedSimulation& played, const Lattice& lattice) {
    static_assert(sizeof(Vec3f) == 3 * sizeof(float) && sizeof(Triangle) == 3 * sizeof(std::uint32_t));
    Deflater deflater;
    for (const TriangleMesh& mesh : played.colliders) deflater.add(bytes_of(mesh.vertices));
    for (const TriangleMesh& mesh : played.colliders) deflater.add(bytes_of(mesh.faces));
    deflater.add(bytes_of(surface_of(played.result.simulation.deformable())));
    add_motion(deflater, played.recording.frames(), lattice);
    return deflater.finish();
}

} // namespace

Player::Player(fs::path path) {
    if (path.empty()) path = installed_player();
    page_ = read_player(path);
    place_ = page_.find(kPlace);
    if (place_ != std::string::npos && page_.find(kPlace, place_ + 1) == std::string::npos) return;
    throw Error(ErrorCode::WrongFormat, path.string() + ": is not a player: it must contain the line " +
                                            std::string(kPlace) +
                                            " once; scripts/web --build-only builds one");
}

std::string_view Player::tail() const {
    return std::string_view(page_).substr(place_ + kPlace.size());
}

void write_player_page(Output& output, const Player& player, const PlayedSimulation& played) {
    const Lattice lattice = lattice_of(played.recording.frames());
    output.write(player.head());
    output.write("<script type=\"application/json\" id=\"description\">");
    output.write(in_script(description_of(played, lattice)));
    output.write("</script>\n<script type=\"text/plain\" id=\"data\">");
    output.write(base64(compressed(played, lattice)));
    output.write("</script>");
    output.write(player.tail());
    output.commit();
}
