#include "mesh/faces.hpp"
#include "property/shape_checks.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

namespace echinus::test {

namespace {

class Shrinker {
  public:
    Shrinker(ShapeFindings::Failure failure, ShapeCheck check)
        : failure_(std::move(failure)), check_(check) {}

    TriangleMesh run(TriangleMesh mesh) {
        bool has_shrunk = true;
        while (has_shrunk) {
            has_shrunk = drop_parts(mesh);
            has_shrunk = join_vertices(mesh) || has_shrunk;
        }
        round_coordinates(mesh);
        replace_if_fails(mesh, weld(mesh));
        return mesh;
    }

  private:
    bool fails(const TriangleMesh& mesh) {
        if (mesh.faces.empty() || tries_ == 0) return false;
        --tries_;
        ShapeFindings findings;
        check_(mesh, failure_.seed, findings);
        return !findings.failures.empty() && findings.failures.front().kind == failure_.kind;
    }
    bool replace_if_fails(TriangleMesh& mesh, TriangleMesh candidate) {
        if (!fails(candidate)) return false;
        mesh = std::move(candidate);
        return true;
    }

    bool drop_parts(TriangleMesh& mesh) {
        bool has_shrunk = false;
        for (std::size_t part = 0;; ++part) {
            const Components components = find_components(mesh);
            if (components.count < 2 || part >= components.count) return has_shrunk;
            TriangleMesh rest{mesh.vertices, {}};
            for (std::size_t face = 0; face < mesh.faces.size(); ++face)
                if (components.of_face[face] != part) rest.faces.push_back(mesh.faces[face]);
            if (!replace_if_fails(mesh, std::move(rest))) continue;
            has_shrunk = true;
            --part;
        }
    }

    /// A closed mesh stays closed when two of its vertices become one.
    static TriangleMesh joined(const TriangleMesh& mesh, std::uint32_t from, std::uint32_t to) {
        TriangleMesh result{mesh.vertices, {}};
        for (Triangle face : mesh.faces) {
            std::ranges::replace(face, from, to);
            if (face[0] != face[1] && face[1] != face[2] && face[2] != face[0]) result.faces.push_back(face);
        }
        return result;
    }

    bool join_vertices(TriangleMesh& mesh) {
        for (std::size_t face = 0; face < mesh.faces.size(); ++face)
            for (std::size_t k = 0; k < 3; ++k)
                if (replace_if_fails(mesh, joined(mesh, mesh.faces[face][k], mesh.faces[face][(k + 1) % 3])))
                    return true;
        return false;
    }

    /// To the fewest binary places that still fail, in units of a power of two about as large as the mesh.
    void round_coordinates(TriangleMesh& mesh) {
        float largest = 0;
        for (const Vec3f& v : mesh.vertices)
            largest = std::max({largest, std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)});
        const int exponent = std::ilogb(largest);
        for (int places = 2; places < 20; ++places) {
            const auto rounded = [&](float x) { return std::round(std::ldexp(x, places - exponent)); };
            TriangleMesh candidate = mesh;
            for (Vec3f& v : candidate.vertices) v = {rounded(v.x), rounded(v.y), rounded(v.z)};
            if (replace_if_fails(mesh, std::move(candidate))) return;
        }
    }

    ShapeFindings::Failure failure_;
    ShapeCheck check_;
    int tries_ = 3000;
};

} // namespace

TriangleMesh shrunk(TriangleMesh mesh, const ShapeFindings::Failure& failure, ShapeCheck check) {
    return Shrinker(failure, check).run(std::move(mesh));
}

std::string obj_text(const TriangleMesh& mesh) {
    std::vector<std::size_t> number(mesh.vertices.size()); // from 1; 0: not used so far
    std::size_t count = 0;
    std::string vertices, faces;
    for (const Triangle& face : mesh.faces) {
        faces += "f";
        for (const std::uint32_t corner : face) {
            const Vec3f& v = mesh.vertices[corner];
            if (number[corner] == 0) {
                number[corner] = ++count;
                vertices +=
                    "v " + shortest_text(v.x) + " " + shortest_text(v.y) + " " + shortest_text(v.z) + "\n";
            }
            faces += " " + std::to_string(number[corner]);
        }
        faces += "\n";
    }
    return vertices + faces;
}

} // namespace echinus::test
