#include "property/shape_judge.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

namespace echinus::test {

namespace {

using Corners = ShapeJudge::Corners;

double distance_to_segment(const Vec3d& p, const Vec3d& a, const Vec3d& b) {
    const Vec3d ab = b - a;
    const double length_sq = dot(ab, ab);
    const double t = length_sq > 0 ? std::clamp(dot(p - a, ab) / length_sq, 0.0, 1.0) : 0;
    return length(p - (a + ab * t));
}

double distance_to_triangle(const Vec3d& p, const Corners& t) {
    const Vec3d normal = cross(t[1] - t[0], t[2] - t[0]);
    const double normal_length = length(normal);
    const auto is_left_of = [&](std::size_t k) {
        return dot(cross(t[(k + 1) % 3] - t[k], p - t[k]), normal) >= 0;
    };
    if (normal_length > 0 && is_left_of(0) && is_left_of(1) && is_left_of(2))
        return std::fabs(dot(p - t[0], normal)) / normal_length;
    return std::min({distance_to_segment(p, t[0], t[1]), distance_to_segment(p, t[1], t[2]),
                     distance_to_segment(p, t[2], t[0])});
}

/// Between two segments, after Ericson, "Real-Time Collision Detection" (2005), section 5.1.9: where the
/// nearest points lie inside of both, they are those of the lines; else an end is one of them.
double distance_of_segments(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d) {
    double least = std::min({distance_to_segment(a, c, d), distance_to_segment(b, c, d),
                             distance_to_segment(c, a, b), distance_to_segment(d, a, b)});
    const Vec3d u = b - a, v = d - c, w = a - c;
    const double uu = dot(u, u), vv = dot(v, v), uv = dot(u, v);
    const double determinant = uu * vv - uv * uv;
    if (determinant <= 1e-14 * uu * vv) return least; // parallel: an end is among the nearest
    const double s = (uv * dot(v, w) - vv * dot(u, w)) / determinant;
    const double t = (uu * dot(v, w) - uv * dot(u, w)) / determinant;
    if (s > 0 && s < 1 && t > 0 && t < 1) least = std::min(least, length(w + u * s - v * t));
    return least;
}

/// Does a segment pass through a triangle?
bool passes_through(const Vec3d& a, const Vec3d& b, const Corners& t) {
    const Vec3d normal = cross(t[1] - t[0], t[2] - t[0]);
    const double before = dot(a - t[0], normal), after = dot(b - t[0], normal);
    if (before * after > 0 || before == after) return false;
    const Vec3d p = a + (b - a) * (before / (before - after));
    const auto is_left_of = [&](std::size_t k) {
        return dot(cross(t[(k + 1) % 3] - t[k], p - t[k]), normal) >= 0;
    };
    return is_left_of(0) && is_left_of(1) && is_left_of(2);
}

double distance_of_triangles(const Corners& a, const Corners& b) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < 3; ++i) {
        if (passes_through(a[i], a[(i + 1) % 3], b) || passes_through(b[i], b[(i + 1) % 3], a)) return 0;
        least = std::min({least, distance_to_triangle(a[i], b), distance_to_triangle(b[i], a)});
        for (std::size_t j = 0; j < 3; ++j)
            least = std::min(least, distance_of_segments(a[i], a[(i + 1) % 3], b[j], b[(j + 1) % 3]));
    }
    return least;
}

/// Calls visit(low, high) for strips from the least to the greatest of some ends, so many at least that they
/// are narrow. All ends are also ends of strips, except for those that differ by mere rounding.
template <typename Visit>
void for_each_strip(std::vector<double>& ends, Visit&& visit) {
    constexpr int kLeastCount = 128;
    constexpr double kRounding = 1e-7; // of the whole
    if (ends.empty()) return;
    std::ranges::sort(ends);
    const double whole = ends.back() - ends.front();
    double low = ends.front();
    for (const double high : ends) {
        if (!(high - low > kRounding * whole) && high != ends.back()) continue;
        const double count = std::floor((high - low) / whole * kLeastCount) + 1;
        for (double i = 0; i < count && high > low; ++i)
            visit(low + (high - low) * (i / count), low + (high - low) * ((i + 1) / count));
        low = high;
    }
}

/// Where a plane x = constant cuts a face. The chords of a closed mesh go around what it encloses.
struct Chord {
    double from_y, from_z, to_y, to_z;
};

std::optional<Chord> cut_face(const Corners& face, double x) {
    Chord chord{};
    bool is_cut = false;
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec3d &a = face[k], &b = face[(k + 1) % 3];
        if ((a.x > x) == (b.x > x)) continue;
        is_cut = true;
        const Vec3d p = a + (b - a) * ((x - a.x) / (b.x - a.x));
        (b.x > x ? chord.to_y : chord.from_y) = p.y;
        (b.x > x ? chord.to_z : chord.from_z) = p.z;
    }
    return is_cut ? std::optional(chord) : std::nullopt;
}

/// How much of a line along z has another winding number than 0.
double enclosed_length(const std::vector<Chord>& section, double y,
                       std::vector<std::pair<double, int>>& crossed) {
    crossed.clear(); // z, and by how much the winding number grows there
    for (const Chord& c : section)
        if ((c.from_y > y) != (c.to_y > y))
            crossed.emplace_back(c.from_z + (c.to_z - c.from_z) * ((y - c.from_y) / (c.to_y - c.from_y)),
                                 c.to_y > y ? 1 : -1);
    std::ranges::sort(crossed);
    int winding = 0;
    double sum = 0;
    for (std::size_t k = 0; k + 1 < crossed.size(); ++k) {
        winding += crossed[k].second;
        if (winding != 0) sum += crossed[k + 1].first - crossed[k].first;
    }
    return sum;
}

double enclosed_area(const std::vector<Chord>& section) {
    std::vector<double> ends;
    for (const Chord& c : section) ends.insert(ends.end(), {c.from_y, c.to_y});
    std::vector<std::pair<double, int>> crossed;
    double sum = 0;
    for_each_strip(ends, [&](double low, double high) {
        sum += enclosed_length(section, (low + high) / 2, crossed) * (high - low);
    });
    return sum;
}

} // namespace

ShapeJudge::ShapeJudge(const TriangleMesh& mesh, double tolerance) : mesh_(mesh), tolerance_(tolerance) {
    for (const auto& [a, b, c] : mesh.faces) {
        const Corners t{Vec3d(mesh.vertices[a]), Vec3d(mesh.vertices[b]), Vec3d(mesh.vertices[c])};
        const Vec3d centre = (t[0] + t[1] + t[2]) * (1.0 / 3);
        const double radius = std::max({length(t[0] - centre), length(t[1] - centre), length(t[2] - centre)});
        faces_.push_back({t, centre, radius});
    }
}

double ShapeJudge::distance(const Vec3d& point) const {
    double least = std::numeric_limits<double>::infinity();
    for (const FaceBall& face : faces_)
        if (length(point - face.centre) < least + face.radius)
            least = std::min(least, distance_to_triangle(point, face.corners));
    return least;
}

std::optional<int> ShapeJudge::winding(const Vec3d& point) const {
    if (distance(point) <= tolerance_) return std::nullopt;
    return winding_away_from_surface(point);
}

std::optional<int> ShapeJudge::winding_away_from_surface(const Vec3d& point) const {
    const double winding = winding_number(mesh_, point);
    const double whole = std::round(winding);
    // A closed mesh has a whole number everywhere: what differs from it is rounding.
    if (!(std::fabs(winding - whole) < 1e-3)) return std::nullopt;
    return static_cast<int>(whole);
}

std::vector<ShapeJudge::Crossing> ShapeJudge::crossings(const Vec3d& from, const Vec3d& to) const {
    std::vector<Crossing> found;
    const Vec3d way = to - from;
    for (std::size_t face = 0; face < face_count(); ++face) {
        const Corners& t = corners(face);
        const bool passes = passes_through(from, to, t);
        double edge_distance = std::numeric_limits<double>::infinity();
        for (std::size_t k = 0; k < 3; ++k)
            edge_distance = std::min(edge_distance, distance_of_segments(from, to, t[k], t[(k + 1) % 3]));
        const Vec3d normal = cross(t[1] - t[0], t[2] - t[0]);
        const double normal_length = length(normal);
        const auto height = [&](const Vec3d& p) {
            return normal_length > 0 ? dot(p - t[0], normal) / normal_length : 0;
        };
        const bool ends_are_clear =
            std::min(distance_to_triangle(from, t), distance_to_triangle(to, t)) > tolerance_;
        if (!passes && edge_distance > tolerance_ && ends_are_clear) continue;
        const double before = height(from), after = height(to);
        const double fraction = before == after ? 0 : std::clamp(before / (before - after), 0.0, 1.0);
        const double steepness = length(way) > 0 ? std::fabs(after - before) / length(way) : 0;
        found.push_back(
            {face, fraction, passes && ends_are_clear && edge_distance > tolerance_ && steepness > 0.01});
    }
    return found;
}

double ShapeJudge::distance(const Corners& triangle, std::size_t face) const {
    return distance_of_triangles(triangle, corners(face));
}

double ShapeJudge::distance(const Corners& triangle) const {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t face = 0; face < face_count(); ++face) least = std::min(least, distance(triangle, face));
    return least;
}

double ShapeJudge::enclosed_volume() const {
    std::vector<double> ends;
    for (const FaceBall& face : faces_)
        for (const Vec3d& corner : face.corners) ends.push_back(corner.x);
    double sum = 0;
    std::vector<Chord> section;
    for_each_strip(ends, [&](double low, double high) {
        // The two points of Gauss.
        for (const double share : {0.5 - std::sqrt(1.0 / 12), 0.5 + std::sqrt(1.0 / 12)}) {
            const double x = low + (high - low) * share;
            section.clear();
            for (const FaceBall& face : faces_)
                if (const std::optional<Chord> chord = cut_face(face.corners, x)) section.push_back(*chord);
            sum += enclosed_area(section) * (high - low) / 2;
        }
    });
    return sum;
}

} // namespace echinus::test
