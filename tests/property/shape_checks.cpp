#include "property/shape_checks.hpp"

#include "property/shape_judge.hpp"
#include "property/shape_parts.hpp"
#include "support/point_sets.hpp"

#include <echinus/distance_map.hpp>
#include <echinus/error.hpp>
#include <echinus/exact_map.hpp>
#include <echinus/map_file.hpp>
#include <echinus/surface_queries.hpp>
#include <echinus/tetrahedra.hpp>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <optional>
#include <span>
#include <variant>

namespace echinus::test {

namespace {

constexpr double kLatticeSteps = 2 * 0x1p-19; ///< in radii: what docs/accuracy.md calls ambiguous
constexpr double kDistanceTolerance = 1e-5;   ///< in radii: docs/accuracy.md
constexpr float kUnlimited = std::numeric_limits<float>::max();

template <typename... Pieces>
std::string text(const Pieces&... pieces) {
    const auto piece = [](const auto& value) {
        if constexpr (std::is_arithmetic_v<std::decay_t<decltype(value)>>)
            return shortest_text(static_cast<float>(value));
        else if constexpr (std::is_same_v<std::decay_t<decltype(value)>, Vec3f>)
            return "(" + shortest_text(value.x) + ", " + shortest_text(value.y) + ", " +
                   shortest_text(value.z) + ")";
        else
            return std::string(value);
    };
    return (piece(pieces) + ...);
}

/// Collects what is wrong with one shape.
class Verdict {
  public:
    Verdict(const TriangleMesh& mesh, std::uint64_t seed, ShapeFindings& findings)
        : seed_(seed), findings_(findings) {
        ++findings.shapes;
        findings.faces += mesh.faces.size();
    }
    ~Verdict() {
        if (failure_.what.empty()) return;
        ++(is_unreadable_ ? findings_.unreadable : findings_.wrong);
        findings_.failures.push_back(failure_);
    }
    Verdict(const Verdict&) = delete;
    Verdict& operator=(const Verdict&) = delete;

    /// An answer, and how it is wrong if it is.
    template <typename... Pieces>
    void expect(bool right, const Pieces&... complaint) {
        ++findings_.answers;
        if (right) return;
        ++findings_.wrong_answers;
        if (failure_.what.empty()) failure_ = {seed_, text(complaint...), first_of(complaint...)};
    }
    void say_unreadable(const std::string& why) {
        is_unreadable_ = true;
        if (failure_.what.empty()) failure_ = {seed_, why, "unreadable"};
    }
    ShapeFindings& findings() { return findings_; }

  private:
    template <typename First, typename... Rest>
    static std::string first_of(const First& first, const Rest&...) {
        return text(first);
    }

    std::uint64_t seed_;
    ShapeFindings& findings_;
    ShapeFindings::Failure failure_;
    bool is_unreadable_ = false;
};

ExactMapOptions map_options(Choices& choices) {
    static constexpr std::uint32_t kDivisions[] = {0, 0, 0, 0, 0, 0, 1, 2, 3, 4, 5, 7, 8, 16};
    ExactMapOptions options;
    options.divisions = choices.one_of(kDivisions);
    if (choices.chance(0.1)) options.centre = CentreChoice::Search;
    if (choices.chance(0.3)) options.rule = InsideRule::Parity;
    options.thread_count = 1;
    return options;
}

bool is_inside(InsideRule rule, int winding) {
    return rule == InsideRule::Nonzero ? winding != 0 : winding % 2 != 0;
}

/// Where maps of directions fail, with a ball to lie in that need not be that of the map.
class ShapePoints {
  public:
    ShapePoints(const TriangleMesh& mesh, const Vec3d& centre, double radius, Choices& choices)
        : mesh_(mesh), centre_(centre), radius_(radius), choices_(choices) {}

    Vec3f next() {
        using Kind = Vec3d (ShapePoints::*)();
        static constexpr Kind kKinds[] = {
            &ShapePoints::anywhere,       &ShapePoints::anywhere,         &ShapePoints::near_face,
            &ShapePoints::near_face,      &ShapePoints::near_corner,      &ShapePoints::between_planes,
            &ShapePoints::between_planes, &ShapePoints::in_central_plane, &ShapePoints::in_central_plane};
        if (choices_.chance(0.02)) return Vec3f(centre_ + offset(100 * radius_));
        return Vec3f((this->*choices_.one_of(kKinds))());
    }

  private:
    Vec3d offset(double reach) {
        const double x = choices_.within(-reach, reach), y = choices_.within(-reach, reach);
        return {x, y, choices_.within(-reach, reach)};
    }
    Vec3d any_corner() { return Vec3d(mesh_.vertices[choices_.one_of(choices_.one_of(mesh_.faces))]); }
    /// From some lattice steps up to a tenth of the radius, every size as likely as the next.
    double small() { return radius_ * std::ldexp(choices_.within(1, 2), -choices_.between(4, 18)); }

    Vec3d anywhere() { return centre_ + offset(radius_); }
    Vec3d near_corner() { return any_corner() + offset(small()); }

    /// Beside a place of a face, often one in the middle of an edge or a fourth of the way.
    Vec3d near_face() {
        const Triangle& face = choices_.one_of(mesh_.faces);
        const Vec3d a(mesh_.vertices[face[0]]), b(mesh_.vertices[face[1]]), c(mesh_.vertices[face[2]]);
        const double u = choices_.chance(0.5) ? choices_.between(0, 4) / 4.0 : choices_.within(0, 1);
        const double v = choices_.chance(0.5) ? choices_.between(0, 4) / 4.0 : choices_.within(0, 1);
        const Vec3d place = a + (b - a) * (u * (1 - v)) + (c - a) * (u * v);
        const Vec3d normal = cross(b - a, c - a);
        const double size = length(normal);
        return size > 0 ? place + normal * ((choices_.chance(0.5) ? small() : -small()) / size) : place;
    }
    /// Each coordinate that of a corner, or in the middle between those of two.
    Vec3d between_planes() {
        const auto coordinate = [&](auto axis) {
            const double first = axis(any_corner());
            return choices_.chance(0.3) ? first : (first + axis(any_corner())) / 2;
        };
        const double x = coordinate([](const Vec3d& p) { return p.x; });
        const double y = coordinate([](const Vec3d& p) { return p.y; });
        return {x, y, coordinate([](const Vec3d& p) { return p.z; })};
    }
    /// In a coordinate plane or a diagonal plane through the centre.
    Vec3d in_central_plane() {
        Vec3d d = offset(radius_);
        switch (choices_.between(0, 8)) {
        case 0:
            d.x = 0;
            break;
        case 1:
            d.y = 0;
            break;
        case 2:
            d.z = 0;
            break;
        case 3:
            d.x = d.y;
            break;
        case 4:
            d.y = -d.z;
            break;
        case 5:
            d.z = d.x;
            break;
        case 6:
            d.x = -d.y;
            d.z = 0;
            break;
        case 7:
            d.y = d.z = d.x;
            break;
        default:
            d.x = d.y = 0;
        }
        return centre_ + d;
    }

    const TriangleMesh& mesh_;
    Vec3d centre_;
    double radius_;
    Choices& choices_;
};

std::vector<Vec3f> points_around(const TriangleMesh& mesh, const ExactMapView& map, std::size_t count,
                                 Choices& choices) {
    std::vector<Vec3f> points = adversarial_points(mesh, {map.centre, map.radius, map.divisions}, count / 3,
                                                   choices.below(1U << 30U));
    ShapePoints more(mesh, Vec3d(map.centre), double{map.radius}, choices);
    while (points.size() < count) points.push_back(more.next());
    return points;
}

/// Nothing is inside, as far as some hundred points tell.
bool encloses_nothing(const TriangleMesh& mesh, Choices& choices) {
    const Sphere sphere = inspect(mesh).bounding_sphere;
    const ShapeJudge judge(mesh, kLatticeSteps * sphere.radius);
    ShapePoints points(mesh, Vec3d(sphere.centre), sphere.radius, choices);
    for (int i = 0; i < 200; ++i)
        if (judge.winding(Vec3d(points.next())).value_or(0) != 0) return false;
    return true;
}

/// The map, or none where there is nothing to be inside of.
std::optional<ExactMap> build_map(const TriangleMesh& mesh, const ExactMapOptions& options, Choices& choices,
                                  Verdict& verdict) {
    try {
        return ExactMap::build(mesh, options);
    } catch (const Error& error) {
        if (error.code() == ErrorCode::InvalidMesh && encloses_nothing(mesh, choices))
            ++verdict.findings().left_out;
        else
            verdict.expect(false, "refused: ", error.what());
        return std::nullopt;
    }
}

template <typename Map>
std::optional<Map> read_back(const Map& map, Verdict& verdict) {
    const auto bytes = std::make_shared<const std::vector<std::byte>>(serialise(map));
    try {
        return std::get<Map>(load_map(*bytes, bytes, "the map"));
    } catch (const Error& error) {
        verdict.say_unreadable(error.what());
        return std::nullopt;
    }
}

bool same_bits(float a, float b) {
    return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b);
}
bool same_bits(const Vec3f& a, const Vec3f& b) {
    return same_bits(a.x, b.x) && same_bits(a.y, b.y) && same_bits(a.z, b.z);
}
bool same_bits(const Contact& a, const Contact& b) {
    return a.inside == b.inside && a.certain == b.certain && a.face == b.face && a.feature == b.feature &&
           same_bits(a.depth, b.depth) && same_bits(a.point, b.point) && same_bits(a.normal, b.normal);
}

std::vector<std::uint8_t> sides_of(const ExactMapView& map, const std::vector<Vec3f>& points) {
    std::vector<std::uint8_t> inside(points.size());
    contains_batch(map, points, inside);
    return inside;
}

std::vector<Contact> contacts_of(const ExactMapView& map, const std::vector<Vec3f>& points) {
    std::vector<Contact> contacts(points.size());
    contacts_batch(map, points, kUnlimited, contacts);
    return contacts;
}

/// A closed map, its mesh and its judge.
struct Subject {
    Subject(const TriangleMesh& mesh_, const ExactMap& map_)
        : mesh(mesh_), map(map_), radius(double{map.view().radius}), judge(mesh, kLatticeSteps * radius) {}

    const TriangleMesh& mesh;
    const ExactMap& map;
    double radius;
    ShapeJudge judge;
};

void check_file(const ExactMap& map, const std::vector<Vec3f>& points,
                const std::vector<std::uint8_t>& inside, const std::vector<Contact>& contacts,
                Verdict& verdict) {
    const std::optional<ExactMap> loaded = read_back(map, verdict);
    if (!loaded) return;
    const std::vector<Contact> loaded_contacts = contacts_of(*loaded, points);
    verdict.expect(sides_of(*loaded, points) == inside, "other sides after saving and loading");
    verdict.expect(std::ranges::equal(loaded_contacts, contacts,
                                      [](const Contact& a, const Contact& b) { return same_bits(a, b); }),
                   "other contacts after saving and loading");
}

// ---- Contacts, distances, winding numbers

void check_contact(const Subject& subject, const Vec3f& p, const Contact& found, double distance,
                   Verdict& verdict) {
    const double radius = subject.radius;
    const double tolerance = kDistanceTolerance * radius + 1e-6 * distance;
    verdict.expect(found.found() && found.certain && found.feature != Feature::Unknown, "no contact at ", p);
    if (found.face >= subject.mesh.faces.size())
        return verdict.expect(false, "a contact without a face at ", p);
    const double rounding = 1e-7 * (length(Vec3d(p)) + distance);
    const Vec3d way = Vec3d(found.point) - Vec3d(p);
    verdict.expect(std::fabs(length(Vec3d(found.normal)) - 1) < 1e-5, "a normal of another length at ", p);
    verdict.expect(std::fabs(length(way) - distance) <= tolerance + rounding, "contact point at ",
                   length(way), " instead of ", distance, " from ", p);
    const ShapeJudge::Corners at{Vec3d(found.point), Vec3d(found.point), Vec3d(found.point)};
    verdict.expect(subject.judge.distance(at, found.face) <= tolerance + rounding, "the contact point of ", p,
                   " is not on its face");
    if (distance > 1e-3 * radius + 100 * rounding)
        verdict.expect(length(Vec3d(found.normal) * double{found.depth} - way) <= 1e-2 * distance,
                       "a normal that does not lead to the contact point from ", p);
}

void check_contacts(const Subject& subject, const std::vector<Vec3f>& points, Verdict& verdict) {
    const ExactMap& map = subject.map;
    const std::vector<Contact> contacts = contacts_of(map, points);
    std::vector<float> distances(points.size()), windings(points.size());
    std::vector<Vec3f> gradients(points.size());
    signed_distance_batch(map, points, distances, gradients);
    winding_number_batch(map, points, windings);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Vec3f& p = points[i];
        const double distance = subject.judge.distance(Vec3d(p));
        check_contact(subject, p, contacts[i], distance, verdict);
        verdict.expect(same_bits(contact(map, p, kUnlimited), contacts[i]),
                       "single and batch contacts differ at ", p);
        Vec3f gradient;
        const float signed_one = signed_distance(map, p, &gradient);
        verdict.expect(same_bits(signed_one, distances[i]) && same_bits(gradient, gradients[i]),
                       "single and batch signed distances differ at ", p);
        verdict.expect(same_bits(-signed_one, contacts[i].depth) &&
                           std::signbit(signed_one) == contacts[i].inside,
                       "signed distance ", signed_one, " and depth ", contacts[i].depth, " differ at ", p);
        verdict.expect(same_bits(gradient, contacts[i].normal), "gradient and normal differ at ", p);
        verdict.expect(same_bits(winding_number(map, p), windings[i]),
                       "single and batch winding numbers differ at ", p);
        if (distance <= kLatticeSteps * subject.radius) continue;
        const std::optional<int> winding = subject.judge.winding_away_from_surface(Vec3d(p));
        if (winding)
            verdict.expect(windings[i] == *winding, "winding number ", windings[i], " instead of ", *winding,
                           " at ", p);
    }
}

// ---- Sweeps

/// Whether a way enters the solid where it passes a face; none where something else is too near to tell.
std::optional<bool> enters(const Subject& subject, const Vec3d& from, const Vec3d& way,
                           const std::vector<ShapeJudge::Crossing>& crossings, const ShapeJudge::Crossing& at,
                           double slack) {
    for (const ShapeJudge::Crossing& other : crossings)
        if (other.face != at.face && std::fabs(other.fraction - at.fraction) <= 2 * slack)
            return std::nullopt;
    const std::optional<int> before = subject.judge.winding(from + way * std::max(0.0, at.fraction - slack));
    const std::optional<int> after = subject.judge.winding(from + way * std::min(1.0, at.fraction + slack));
    if (!before || !after) return std::nullopt;
    const InsideRule rule = subject.map.view().rule;
    return !is_inside(rule, *before) && is_inside(rule, *after);
}

void check_sweep(const Subject& subject, const Vec3f& from, const Vec3f& to, Verdict& verdict) {
    const Vec3d start(from), way = Vec3d(to) - start;
    if (length(way) <= 1e-3 * subject.radius) return;
    const SweepHit hit = sweep(subject.map, from, to);
    const std::vector<ShapeJudge::Crossing> crossings = subject.judge.crossings(start, Vec3d(to));
    // Clear crossings are steeper than a hundredth, so that the lattice moves them by no more than this.
    const double slack = 1e-3 * subject.radius / length(way);
    for (const ShapeJudge::Crossing& crossing : crossings)
        if (crossing.clear)
            verdict.expect(hit.found() && hit.fraction <= crossing.fraction + slack, "a sweep misses face ",
                           crossing.face, " from ", from, " to ", to);
    if (!hit.found()) {
        const std::optional<int> first = subject.judge.winding(start),
                                 last = subject.judge.winding(Vec3d(to));
        if (first && last) verdict.expect(*first == *last, "a sweep meets nothing from ", from, " to ", to);
        return;
    }
    const double rounding = 1e-7 * (length(start) + length(Vec3d(to)));
    verdict.expect(subject.judge.distance(Vec3d(hit.point)) <= kDistanceTolerance * subject.radius + rounding,
                   "a sweep ends off the surface from ", from, " to ", to);
    const auto met =
        std::ranges::find(crossings, static_cast<std::size_t>(hit.face), &ShapeJudge::Crossing::face);
    verdict.expect(met != crossings.end(), "a sweep meets another face from ", from, " to ", to);
    if (met == crossings.end() || !met->clear) return;
    verdict.expect(std::fabs(hit.fraction - met->fraction) <= slack, "a sweep has another fraction from ",
                   from, " to ", to);
    if (const auto entering = enters(subject, start, way, crossings, *met, slack))
        verdict.expect(hit.entering == *entering, "a sweep mistakes in and out from ", from, " to ", to);
}

// ---- Triangles

ShapeJudge::Corners in_double(const TrianglePoints& t) {
    return {Vec3d(t[0]), Vec3d(t[1]), Vec3d(t[2])};
}

double extent_of(const Subject& subject, const TrianglePoints& triangle) {
    double extent = subject.radius;
    for (const Vec3f& p : triangle)
        extent = std::max(extent, length(Vec3d(p) - Vec3d(subject.map.view().centre)));
    return extent;
}

void check_clearance(const Subject& subject, const TrianglePoints& triangle, Verdict& verdict) {
    const ShapeJudge::Corners corners = in_double(triangle);
    const double extent = extent_of(subject, triangle);
    const double tolerance = 8e-6 * extent;
    const float reach = static_cast<float>(0.3 * subject.radius);
    FaceLists near;
    faces_within_batch(subject.map, triangle, std::vector<Triangle>{{0, 1, 2}}, reach, near, 1);
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t face = 0; face < subject.mesh.faces.size(); ++face) {
        const double distance = subject.judge.distance(corners, face);
        least = std::min(least, distance);
        const bool is_listed = std::ranges::binary_search(near[0], static_cast<std::uint32_t>(face));
        if (std::fabs(distance - reach) > tolerance)
            verdict.expect(is_listed == (distance < reach), "face ", face, " at ", distance,
                           " from the triangle ", triangle[0], triangle[1], triangle[2],
                           is_listed ? " is listed" : " is not listed");
    }
    const Clearance found = clearance(subject.map, triangle);
    verdict.expect(found.found() && std::fabs(found.distance - least) <= tolerance, "clearance ",
                   found.distance, " instead of ", least, " of ", triangle[0], triangle[1], triangle[2]);
    if (least > tolerance)
        verdict.expect(!intersects(subject.map, triangle), "intersects at a distance of ", least, ": ",
                       triangle[0], triangle[1], triangle[2]);
    for (std::size_t k = 0; k < 3; ++k)
        for (const ShapeJudge::Crossing& crossing : subject.judge.crossings(corners[k], corners[(k + 1) % 3]))
            if (crossing.clear)
                verdict.expect(intersects(subject.map, triangle), "does not intersect face ", crossing.face,
                               ": ", triangle[0], triangle[1], triangle[2]);
}

void check_triangle_sweep(const Subject& subject, const TrianglePoints& from, const TrianglePoints& to,
                          Verdict& verdict) {
    const TriangleSweepHit hit = sweep(subject.map, from, to);
    const auto corners_at = [&](double fraction) {
        ShapeJudge::Corners corners = in_double(from);
        for (std::size_t k = 0; k < 3; ++k) corners[k] += (Vec3d(to[k]) - corners[k]) * fraction;
        return corners;
    };
    constexpr int kSamples = 6;
    for (int i = 0; i < kSamples && hit.fraction > 0; ++i) {
        const ShapeJudge::Corners corners = corners_at(hit.fraction * i / kSamples);
        for (std::size_t k = 0; k < 3; ++k)
            for (const auto& crossing : subject.judge.crossings(corners[k], corners[(k + 1) % 3]))
                verdict.expect(!crossing.clear, "a triangle passes a face: ", crossing.face, ", before ",
                               hit.fraction, " of its way from ", from[0], from[1], from[2], " to ", to[0],
                               to[1], to[2]);
    }
    if (!hit.found() || hit.fraction >= 1) return;
    const double distance = subject.judge.distance(corners_at(hit.fraction));
    verdict.expect(distance <= 1e-5 * extent_of(subject, to), "a triangle stops off the surface: ", distance,
                   ", ", hit.fraction, " of its way from ", from[0], from[1], from[2], " to ", to[0], to[1],
                   to[2]);
}

void check_triangles(const Subject& subject, const std::vector<Vec3f>& points, Choices& choices,
                     Verdict& verdict) {
    const auto near = [&](const Vec3f& p, double reach) {
        const auto coordinate = [&] { return choices.within(-1, 1) * reach * subject.radius; };
        const double x = coordinate(), y = coordinate();
        return Vec3f(Vec3d(p) + Vec3d{x, y, coordinate()});
    };
    for (int i = 0; i < 4; ++i) {
        const Vec3f& p = choices.one_of(points);
        TrianglePoints triangle{p, near(p, 0.2), near(p, 0.2)};
        if (i == 0) triangle = {p, choices.one_of(points), choices.one_of(points)};
        if (i == 1) triangle[2] = triangle[1];
        if (extent_of(subject, triangle) > 8 * subject.radius) continue; // where the lattice is coarser
        check_clearance(subject, triangle, verdict);
        const Vec3f way = near({}, 1);
        if (i > 0)
            check_triangle_sweep(subject, triangle,
                                 {triangle[0] + way, triangle[1] + way, triangle[2] + near({}, 1)}, verdict);
    }
}

// ---- Maps made again, and the paper's

void check_rebuilt(const Subject& subject, const ExactMapOptions& options, Choices& choices,
                   Verdict& verdict) {
    ExactMapBuilder builder(subject.mesh.faces, options);
    std::vector<Vec3f> vertices = subject.mesh.vertices;
    const Vec3f shift = subject.mesh.vertices[choices.below(vertices.size())];
    for (Vec3f& v : vertices) v = Vec3f{v.x * 0.5F, v.y + v.x, v.z} + shift;
    try {
        (void)builder.rebuild(vertices);
    } catch (const Error&) { // flat now; the builder can be used again
    }
    verdict.expect(serialise(builder.rebuild(subject.mesh.vertices)) == serialise(subject.map),
                   "a rebuilt map differs from a new one");
}

void check_distance_map(const Subject& subject, Choices& choices, Verdict& verdict) {
    DistanceMapOptions options;
    options.grid = choices.one_of(std::array{DirectionGrid::Spherical, DirectionGrid::Spherical,
                                             DirectionGrid::Octahedral, DirectionGrid::Cube,
                                             DirectionGrid::Ellipsoidal});
    options.longitude_count = static_cast<std::uint32_t>(choices.between(4, 24));
    options.colatitude_count = static_cast<std::uint32_t>(choices.between(4, 24));
    options.divisions = static_cast<std::uint32_t>(choices.between(4, 12));
    options.correction = choices.chance(0.5) ? VertexCorrection::None : VertexCorrection::Signed;
    options.entry_format = choices.chance(0.5) ? EntryFormat::Float32 : EntryFormat::Unorm16;
    options.thread_count = 1;
    const DistanceMap map = DistanceMap::build(subject.mesh, options);
    const DistanceMapView& view = map;
    verdict.expect(map.statistics().wrong_parity_share == 0, "a distance map sees a hole");
    const auto is_odd = [&](std::size_t d) {
        return (view.entry_offsets[d + 1] - view.entry_offsets[d]) % 2 == 1;
    };
    for (std::size_t d = 0; d < view.direction_count(); ++d)
        verdict.expect(is_odd(d) == view.centre_inside, "direction ", d,
                       " of a distance map has another parity than the centre");
    if (const std::optional<int> winding = subject.judge.winding(Vec3d(view.centre)))
        verdict.expect(view.centre_inside == (*winding % 2 != 0),
                       "a distance map has its centre on the wrong side");
    const std::optional<DistanceMap> loaded = read_back(map, verdict);
    // On the samples' rays nothing is interpolated.
    if (options.grid != DirectionGrid::Spherical || options.correction != VertexCorrection::None) return;
    for (int i = 0; i < 60; ++i) {
        const double longitude =
            2 * std::numbers::pi * choices.below(options.longitude_count) / options.longitude_count;
        const double colatitude = std::numbers::pi *
                                  (static_cast<double>(choices.below(options.colatitude_count)) + 0.5) /
                                  options.colatitude_count;
        const double r = choices.within(0, 1) * double{view.radius};
        const Vec3f p(Vec3d(view.centre) + Vec3d{std::sin(colatitude) * std::cos(longitude),
                                                 std::sin(colatitude) * std::sin(longitude),
                                                 std::cos(colatitude)} *
                                               r);
        if (loaded)
            verdict.expect(contains(*loaded, p) == contains(map, p),
                           "a loaded distance map has another side at ", p);
        if (subject.judge.distance(Vec3d(p)) <= 1e-3 * subject.radius + 1e3 * 0x1p-24 * length(Vec3d(p)))
            continue;
        if (const std::optional<int> winding = subject.judge.winding_away_from_surface(Vec3d(p)))
            verdict.expect(contains(map, p) == (*winding % 2 != 0),
                           "a distance map is wrong on a sample's ray at ", p);
    }
}

// ---- Tetrahedra

constexpr double kMostTetrahedra = 1e5; ///< at first; with each finer size eight times as many
constexpr int kSizes = 3;               ///< to try, each half of the one before

/// As a user does whom tetrahedralize() tells that floats are too coarse far from the origin.
TriangleMesh around_origin(TriangleMesh mesh) {
    const Vec3d centre(inspect(mesh).bounding_sphere.centre);
    for (Vec3f& v : mesh.vertices) v = Vec3f(Vec3d(v) - centre);
    return mesh;
}

double area_of(const TriangleMesh& mesh) {
    double sum = 0;
    for (const auto& [a, b, c] : mesh.faces) {
        const Vec3d origin(mesh.vertices[a]);
        sum += length(cross(Vec3d(mesh.vertices[b]) - origin, Vec3d(mesh.vertices[c]) - origin)) / 2;
    }
    return sum;
}

/// 0 where nothing of that size fits into the model.
double tetrahedra_volume(const ExactMap& map, double size) {
    try {
        return inspect_tetrahedra(tetrahedralize(map, {.size = size, .thread_count = 1}).mesh).volume;
    } catch (const Error&) {
        return 0;
    }
}

} // namespace

std::string shortest_text(float number) {
    char digits[32];
    return {digits, std::to_chars(digits, std::end(digits), number).ptr};
}

void ShapeFindings::add(const ShapeFindings& others) {
    shapes += others.shapes;
    faces += others.faces;
    left_out += others.left_out;
    unreadable += others.unreadable;
    wrong += others.wrong;
    answers += others.answers;
    wrong_answers += others.wrong_answers;
    worst_distance = std::max(worst_distance, others.worst_distance);
    worst_volume = std::max(worst_volume, others.worst_volume);
    failures.insert(failures.end(), others.failures.begin(), others.failures.end());
}

void check_sides(const TriangleMesh& mesh, std::uint64_t seed, ShapeFindings& findings) {
    Verdict verdict(mesh, seed, findings);
    Choices choices(seed + 1);
    const std::optional<ExactMap> map = build_map(mesh, map_options(choices), choices, verdict);
    if (!map) return;
    const Subject subject(mesh, *map);
    const std::vector<Vec3f> points = points_around(mesh, *map, 96, choices);
    const std::vector<std::uint8_t> inside = sides_of(*map, points);
    const std::vector<Contact> contacts = contacts_of(*map, points);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Vec3f& p = points[i];
        const Containment side = classify(*map, p);
        verdict.expect(side.inside == (inside[i] != 0) && side.inside == contains(*map, p) && side.certain &&
                           contacts[i].inside == side.inside,
                       "sides of one mind differ at ", p);
        const double distance = subject.judge.distance(Vec3d(p));
        const double error = std::fabs(std::fabs(double{contacts[i].depth}) - distance);
        if (distance < 2 * subject.radius)
            findings.worst_distance = std::max(findings.worst_distance, error / subject.radius);
        verdict.expect(error <= kDistanceTolerance * subject.radius + 1e-6 * distance, "depth ",
                       contacts[i].depth, " instead of ", distance, " at ", p);
        if (distance <= kLatticeSteps * subject.radius) continue;
        if (const std::optional<int> winding = subject.judge.winding_away_from_surface(Vec3d(p)))
            verdict.expect(side.inside == is_inside(map->view().rule, *winding), "wrong side at ", p, ", ",
                           distance / subject.radius, " R from the surface; winding number ", *winding);
    }
    check_file(*map, points, inside, contacts, verdict);
}

void check_queries(const TriangleMesh& mesh, std::uint64_t seed, ShapeFindings& findings) {
    Verdict verdict(mesh, seed, findings);
    Choices choices(seed + 2);
    const ExactMapOptions options = map_options(choices);
    const std::optional<ExactMap> map = build_map(mesh, options, choices, verdict);
    if (!map) return;
    const Subject subject(mesh, *map);
    const std::vector<Vec3f> points = points_around(mesh, *map, 48, choices);
    check_contacts(subject, points, verdict);
    for (std::size_t i = 0; i + 1 < points.size(); ++i)
        check_sweep(subject, points[i], points[i + 1], verdict);
    check_triangles(subject, points, choices, verdict);
    check_rebuilt(subject, options, choices, verdict);
    check_distance_map(subject, choices, verdict);
}

void check_tetrahedra(const TriangleMesh& mesh, std::uint64_t seed, ShapeFindings& findings) {
    Verdict verdict(mesh, seed, findings);
    Choices choices(seed + 3);
    const TriangleMesh centred = around_origin(mesh);
    const std::optional<ExactMap> map = build_map(centred, {.thread_count = 1}, choices, verdict);
    if (!map) return;
    const double volume = ShapeJudge(centred, 0).enclosed_volume();
    double size = volume / area_of(centred);
    if (!(12 * volume / (size * size * size) <= kMostTetrahedra)) {
        ++findings.left_out;
        return;
    }
    double error = 1;
    for (int i = 0; i < kSizes && error > 0.03; ++i, size /= 2)
        error = std::fabs(tetrahedra_volume(*map, size) / volume - 1);
    findings.worst_volume = std::max(findings.worst_volume, error);
    verdict.expect(error <= 0.03, "another volume of tetrahedra: by a share of ", error);
}

} // namespace echinus::test
