#include "support/point_sets.hpp"

#include "support/random_points.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace echinus::test {

namespace {

std::array<Vec3d, 3> corners_of(const TriangleMesh& mesh, const Triangle& face) {
    return {Vec3d(mesh.vertices[face[0]]), Vec3d(mesh.vertices[face[1]]), Vec3d(mesh.vertices[face[2]])};
}

Vec3d area_vector(const std::array<Vec3d, 3>& corners) {
    return cross(corners[1] - corners[0], corners[2] - corners[0]) * 0.5;
}

/// A point of a triangle, uniform by area: folding the unit square along its diagonal.
Vec3d point_of(const std::array<Vec3d, 3>& corners, PortableRandom& random) {
    double u = random.uniform();
    double v = random.uniform();
    if (u + v > 1) {
        u = 1 - u;
        v = 1 - v;
    }
    return corners[0] + (corners[1] - corners[0]) * u + (corners[2] - corners[0]) * v;
}

/// Heights over a rectangle seen from above, in a frame whose z axis points up.
class Sheet {
  public:
    Sheet(const TriangleMesh& mesh, std::size_t columns, std::size_t rows, Axis up)
        : columns_(columns), rows_(rows), up_(up) {
        find_box(mesh);
        heights_.assign(columns * rows, low_.z);
        for (const Triangle& face : mesh.faces) lay_over(corners_of(mesh, face));
    }

    /// Three box filters in a row come near to a Gaussian of the variance of all three together.
    void smooth(double deviation) {
        const auto half_width = [&](std::size_t count) {
            const double samples = deviation * static_cast<double>(count);
            return static_cast<std::ptrdiff_t>(std::lround((std::sqrt(4 * samples * samples + 1) - 1) / 2));
        };
        for (int pass = 0; pass < 3; ++pass) {
            for (std::size_t row = 0; row < rows_; ++row)
                average_line(row * columns_, columns_, 1, half_width(columns_));
            for (std::size_t column = 0; column < columns_; ++column)
                average_line(column, rows_, columns_, half_width(rows_));
        }
    }

    /// The middle one of so many samples in either direction.
    std::vector<Vec3f> points(std::size_t columns_each, std::size_t rows_each) const {
        std::vector<Vec3f> result;
        result.reserve(heights_.size() / (columns_each * rows_each));
        for (std::size_t row = rows_each / 2; row < rows_; row += rows_each)
            for (std::size_t column = columns_each / 2; column < columns_; column += columns_each)
                result.emplace_back(from_sheet({x_of(column), y_of(row), heights_[row * columns_ + column]}));
        return result;
    }

  private:
    Vec3d to_sheet(const Vec3d& v) const {
        return up_ == Axis::X ? Vec3d{v.y, v.z, v.x} : up_ == Axis::Y ? Vec3d{v.z, v.x, v.y} : v;
    }
    Vec3d from_sheet(const Vec3d& v) const {
        return up_ == Axis::X ? Vec3d{v.z, v.x, v.y} : up_ == Axis::Y ? Vec3d{v.y, v.z, v.x} : v;
    }
    double x_of(std::size_t column) const {
        return low_.x +
               (high_.x - low_.x) * (static_cast<double>(column) + 0.5) / static_cast<double>(columns_);
    }
    double y_of(std::size_t row) const {
        return low_.y + (high_.y - low_.y) * (static_cast<double>(row) + 0.5) / static_cast<double>(rows_);
    }

    void find_box(const TriangleMesh& mesh) {
        constexpr double kInfinity = std::numeric_limits<double>::infinity();
        low_ = {kInfinity, kInfinity, kInfinity};
        high_ = -low_;
        for (const Triangle& face : mesh.faces)
            for (const Vec3d& corner : corners_of(mesh, face)) {
                const Vec3d p = to_sheet(corner);
                low_ = {std::min(low_.x, p.x), std::min(low_.y, p.y), std::min(low_.z, p.z)};
                high_ = {std::max(high_.x, p.x), std::max(high_.y, p.y), std::max(high_.z, p.z)};
            }
    }

    void lay_over(std::array<Vec3d, 3> corners) {
        for (Vec3d& corner : corners) corner = to_sheet(corner);
        const auto& [a, b, c] = corners;
        const double area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
        if (area == 0) return; // seen edge-on
        const auto [first_column, last_column] =
            range(std::min({a.x, b.x, c.x}), std::max({a.x, b.x, c.x}), low_.x, high_.x, columns_);
        const auto [first_row, last_row] =
            range(std::min({a.y, b.y, c.y}), std::max({a.y, b.y, c.y}), low_.y, high_.y, rows_);
        for (std::size_t row = first_row; row < last_row; ++row)
            for (std::size_t column = first_column; column < last_column; ++column) {
                const double x = x_of(column), y = y_of(row);
                const double v = ((x - a.x) * (c.y - a.y) - (y - a.y) * (c.x - a.x)) / area;
                const double w = ((b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x)) / area;
                if (v < 0 || w < 0 || v + w > 1) continue;
                double& height = heights_[row * columns_ + column];
                height = std::max(height, a.z + (b.z - a.z) * v + (c.z - a.z) * w);
            }
    }

    /// The samples between two coordinates, and one more on either side.
    static std::pair<std::size_t, std::size_t> range(double from, double to, double low, double high,
                                                     std::size_t count) {
        const double per_unit = static_cast<double>(count) / (high - low);
        const double first = std::floor((from - low) * per_unit - 0.5);
        const double last = std::ceil((to - low) * per_unit + 0.5);
        return {static_cast<std::size_t>(std::max(first, 0.0)),
                std::min(count, static_cast<std::size_t>(std::max(last, 0.0)))};
    }

    /// Replaces each height of a line by the mean of those at most `half_width` away; beyond the ends the
    /// floor goes on.
    void average_line(std::size_t first, std::size_t count, std::size_t stride, std::ptrdiff_t half_width) {
        std::vector<double> sums(count + 1); // of the heights above the floor
        for (std::size_t i = 0; i < count; ++i) sums[i + 1] = sums[i] + heights_[first + i * stride] - low_.z;
        const auto last = static_cast<std::ptrdiff_t>(count);
        for (std::ptrdiff_t i = 0; i < last; ++i) {
            const auto begin = static_cast<std::size_t>(std::max<std::ptrdiff_t>(i - half_width, 0));
            const auto end = static_cast<std::size_t>(std::min(i + half_width + 1, last));
            heights_[first + static_cast<std::size_t>(i) * stride] =
                low_.z + (sums[end] - sums[begin]) / static_cast<double>(2 * half_width + 1);
        }
    }

    std::size_t columns_, rows_;
    Axis up_;
    Vec3d low_, high_;
    std::vector<double> heights_; ///< [rows * columns]
};

/// Into how many a sample of a coarse sheet is divided: an odd number, so that there is one in its middle;
/// enough for the smoothing boxes, which are whole samples wide, to approximate the requested width.
std::size_t division_of(std::size_t sample_count) {
    constexpr std::size_t kFine = 300;
    return sample_count >= kFine ? 1 : 2 * (kFine / (2 * sample_count)) + 1;
}

} // namespace

std::vector<Vec3f> uniform_points(const TriangleMesh& mesh, std::size_t count, std::uint64_t seed) {
    PortableRandom random(seed);
    const Sphere sphere = inspect(mesh).bounding_sphere;
    std::vector<Vec3f> points;
    points.reserve(count);
    while (points.size() < count) {
        const double x = random.uniform(-1, 1);
        const double y = random.uniform(-1, 1);
        const Vec3d unit{x, y, random.uniform(-1, 1)};
        if (dot(unit, unit) <= 1) points.emplace_back(sphere.centre + unit * sphere.radius);
    }
    return points;
}

std::vector<Vec3f> surface_points(const TriangleMesh& mesh, std::size_t count, double spread,
                                  std::uint64_t seed) {
    PortableRandom random(seed);
    const double deviation = inspect(mesh).bounding_sphere.radius * spread;
    std::vector<double> area_up_to; // [face_count] areas summed
    double area = 0;
    for (const Triangle& face : mesh.faces)
        area_up_to.push_back(area += length(area_vector(corners_of(mesh, face))));

    std::vector<Vec3f> points;
    points.reserve(count);
    while (points.size() < count) {
        const auto chosen = std::upper_bound(area_up_to.begin(), area_up_to.end(), random.uniform(0, area));
        const auto face = std::min<std::ptrdiff_t>(chosen - area_up_to.begin(), std::ssize(mesh.faces) - 1);
        const auto corners = corners_of(mesh, mesh.faces[static_cast<std::size_t>(face)]);
        const Vec3d normal = area_vector(corners);
        const Vec3d on_surface = point_of(corners, random);
        points.emplace_back(on_surface + normal * (deviation * random.normal() / length(normal)));
    }
    return points;
}

std::vector<Vec3f> cloth_points(const TriangleMesh& mesh, std::size_t columns, std::size_t rows, Axis up,
                                double smoothing) {
    const std::size_t columns_each = division_of(columns), rows_each = division_of(rows);
    Sheet sheet(mesh, columns * columns_each, rows * rows_each, up);
    sheet.smooth(smoothing);
    return sheet.points(columns_each, rows_each);
}

namespace {

class Generator {
  public:
    Generator(const TriangleMesh& mesh, const MapFrame& frame, std::uint64_t seed)
        : mesh_(mesh), frame_(frame), random_(seed), edge_on_(edge_on_faces()) {}

    Vec3f next() {
        static constexpr std::array kKinds{&Generator::on_vertex,
                                           &Generator::on_edge,
                                           &Generator::on_face,
                                           &Generator::ray_of_vertex,
                                           &Generator::ray_of_edge,
                                           &Generator::on_coordinate_plane,
                                           &Generator::on_cell_wall,
                                           &Generator::near_edge_on,
                                           &Generator::steps_from_face,
                                           &Generator::steps_from_edge,
                                           &Generator::near_vertex,
                                           &Generator::near_lattice_vertex,
                                           &Generator::between_lattice_vertices,
                                           &Generator::near_centre};
        return (this->*kKinds[index_++ % kKinds.size()])();
    }

  private:
    using Corners = std::array<Vec3d, 3>;

    Corners corners_of(std::size_t face) const {
        const auto& [a, b, c] = mesh_.faces[face];
        return {Vec3d(mesh_.vertices[a]), Vec3d(mesh_.vertices[b]), Vec3d(mesh_.vertices[c])};
    }

    /// How edge-on a face is seen: the sine of the angle between it and the ray to its middle.
    double elevation(std::size_t face) const {
        const auto [a, b, c] = corners_of(face);
        const Vec3d normal = cross(b - a, c - a);
        const Vec3d ray = (a + b + c) * (1.0 / 3) - Vec3d(frame_.centre);
        const double scale = length(normal) * length(ray);
        return scale > 0 ? std::fabs(dot(normal, ray)) / scale : 1;
    }

    /// The 5 % of the faces that are seen most edge-on.
    std::vector<std::uint32_t> edge_on_faces() const {
        std::vector<std::pair<double, std::uint32_t>> faces;
        for (std::uint32_t i = 0; i < mesh_.faces.size(); ++i) faces.emplace_back(elevation(i), i);
        const std::size_t count = std::max<std::size_t>(1, faces.size() / 20);
        std::ranges::nth_element(faces, faces.begin() + static_cast<std::ptrdiff_t>(count - 1));
        std::vector<std::uint32_t> chosen;
        for (std::size_t i = 0; i < count; ++i) chosen.push_back(faces[i].second);
        return chosen;
    }

    std::size_t below(std::size_t count) {
        return std::min(count - 1, static_cast<std::size_t>(random_.uniform() * static_cast<double>(count)));
    }
    /// A whole number in [-most, most].
    double whole(int most) {
        return static_cast<double>(below(2 * static_cast<std::size_t>(most) + 1)) - most;
    }
    Vec3d offset(int most) {
        const double x = whole(most), y = whole(most);
        return {x, y, whole(most)};
    }

    Corners random_face() { return corners_of(below(mesh_.faces.size())); }
    Vec3d random_vertex() { return random_face()[below(3)]; }
    Vec3d point_of_edge() {
        const Corners corners = random_face();
        const std::size_t k = below(3);
        // Halves, quarters and the like can lie exactly on the edge in float.
        const double t = random_.uniform() < 0.5 ? random_.uniform() : static_cast<double>(below(17)) / 16;
        return corners[k] + (corners[(k + 1) % 3] - corners[k]) * t;
    }
    Vec3d point_of_face(const Corners& corners) {
        double u = random_.uniform(), v = random_.uniform();
        if (u + v > 1) {
            u = 1 - u;
            v = 1 - v;
        }
        return corners[0] + (corners[1] - corners[0]) * u + (corners[2] - corners[0]) * v;
    }
    static Vec3d unit_normal(const Corners& corners) {
        const Vec3d normal = cross(corners[1] - corners[0], corners[2] - corners[0]);
        const double l = length(normal);
        return l > 0 ? normal * (1 / l) : Vec3d{0, 0, 1};
    }

    Vec3d to_lattice(const Vec3d& p) const {
        const Vec3d d = (p - Vec3d(frame_.centre)) * (1 / frame_.step());
        return {std::round(d.x), std::round(d.y), std::round(d.z)};
    }
    Vec3f from_lattice(const Vec3d& p) const { return Vec3f(Vec3d(frame_.centre) + p * frame_.step()); }
    /// A random point on the ray from the centre through a position.
    Vec3f along_ray(const Vec3d& through) {
        const Vec3d centre(frame_.centre);
        return Vec3f(centre + (through - centre) * random_.uniform(0, 1.3));
    }

    Vec3f on_vertex() { return Vec3f(random_vertex()); }
    Vec3f on_edge() { return Vec3f(point_of_edge()); }
    Vec3f on_face() { return Vec3f(point_of_face(random_face())); }
    Vec3f ray_of_vertex() { return along_ray(random_vertex()); }
    Vec3f ray_of_edge() { return along_ray(point_of_edge()); }

    /// One or two coordinates equal the centre's.
    Vec3f on_coordinate_plane() {
        const auto spread = [&] {
            return static_cast<float>(random_.uniform(-1, 1) * static_cast<double>(frame_.radius));
        };
        Vec3f p = frame_.centre;
        const std::size_t kind = below(6);
        if (kind != 0 && kind != 3) p.x += spread();
        if (kind != 1 && kind != 4) p.y += spread();
        if (kind != 2 && kind != 5) p.z += spread();
        if (kind == 3) p.y = frame_.centre.y;
        return p;
    }

    /// Where n |x| / (|x| + |y| + |z|) is a whole number, for a random coordinate.
    Vec3f on_cell_wall() {
        const double n = frame_.divisions;
        const double sixteenths = random_.uniform(1, 0x1p19 / n); // of the L1 norm, so that the wall is exact
        const double scale = std::floor(sixteenths);
        const double i = static_cast<double>(below(frame_.divisions + 1));
        const double rest = (n - i) * scale;
        const double share = random_.uniform() < 0.3 ? static_cast<double>(below(frame_.divisions + 1)) / n
                                                     : random_.uniform();
        const double second = std::round(rest * share);
        std::array<double, 3> p{i * scale, second, rest - second};
        std::ranges::rotate(p, p.begin() + static_cast<std::ptrdiff_t>(below(3)));
        for (double& coordinate : p) coordinate = random_.uniform() < 0.5 ? coordinate : -coordinate;
        return from_lattice({p[0], p[1], p[2]});
    }

    Vec3f near_edge_on() {
        const Corners corners = corners_of(edge_on_[below(edge_on_.size())]);
        const double distance = random_.normal() * 3 * frame_.step();
        return Vec3f(point_of_face(corners) + unit_normal(corners) * distance);
    }
    Vec3f steps_from_face() {
        const Corners corners = random_face();
        return Vec3f(point_of_face(corners) + unit_normal(corners) * (whole(4) * frame_.step()));
    }
    Vec3f steps_from_edge() { return Vec3f(point_of_edge() + offset(4) * frame_.step()); }
    Vec3f near_vertex() {
        const double x = random_.uniform(-1.5, 1.5), y = random_.uniform(-1.5, 1.5);
        return Vec3f(random_vertex() + Vec3d{x, y, random_.uniform(-1.5, 1.5)} * frame_.step());
    }
    Vec3f near_lattice_vertex() { return from_lattice(to_lattice(random_vertex()) + offset(2)); }
    Vec3f between_lattice_vertices() {
        const Corners corners = random_face();
        const std::size_t k = below(3);
        const Vec3d middle = to_lattice(corners[k]) + to_lattice(corners[(k + 1) % 3]);
        return from_lattice({std::round(middle.x / 2), std::round(middle.y / 2), std::round(middle.z / 2)});
    }
    Vec3f near_centre() { return from_lattice(offset(static_cast<int>(below(4)))); }

    const TriangleMesh& mesh_;
    MapFrame frame_;
    test::PortableRandom random_;
    std::vector<std::uint32_t> edge_on_;
    std::size_t index_ = 0;
};

} // namespace

std::vector<Vec3f> adversarial_points(const TriangleMesh& mesh, const MapFrame& frame, std::size_t count,
                                      std::uint64_t seed) {
    Generator generator(mesh, frame, seed);
    std::vector<Vec3f> points(count);
    std::ranges::generate(points, [&] { return generator.next(); });
    return points;
}

} // namespace echinus::test
