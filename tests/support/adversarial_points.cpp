#include "support/adversarial_points.hpp"

#include "support/portable_random.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace echinus::test {

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
