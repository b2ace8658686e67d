#pragma once

#include <echinus/mesh.hpp>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

/// A set of particles around a mesh.
struct ParticleSet {
    std::string name; ///< U, S, C, or one of these and 10k for a batch of ten thousand
    std::vector<echinus::Vec3f> points;
};

/// A mesh that systems are compared on.
struct Subject {
    std::string name;
    echinus::TriangleMesh mesh;
    double radius; ///< R, of the bounding sphere
    bool large;    ///< the slow systems are left out

    /// U, S and C of `count` particles each. C has a square number, so perhaps a few fewer.
    std::vector<ParticleSet> sets(std::size_t count) const;

    bool z_is_up;
};

/// The meshes of the comparison, each made when it is its turn: horse_6k, the torus of 2880 faces,
/// armadillo_52k and a torus of about a million faces. Without the folder of development meshes the horse is
/// Debian's, repaired, and the armadillo is left out, with a message on standard error.
std::vector<std::function<Subject()>> subjects(const std::filesystem::path& meshes,
                                               const std::filesystem::path& debian_horse);

/// The first of them.
Subject horse_subject(const std::filesystem::path& meshes, const std::filesystem::path& debian_horse);

/// A torus of radii 1 and 0.4 and about so many faces, nearly square in pairs.
echinus::TriangleMesh torus_of(std::size_t face_count);
