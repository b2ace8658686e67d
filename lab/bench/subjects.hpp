#pragma once

#include "compare/measuring.hpp"
#include "support/point_sets.hpp"

#include <echinus/mesh.hpp>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

/// A mesh on which systems are compared.
struct Subject {
    std::string name;
    echinus::TriangleMesh mesh;
    double radius;      ///< R, of the bounding sphere
    bool large = false; ///< the slow systems are left out

    echinus::test::Axis up;

    /// U, S and C of `count` particles each, not yet judged. C has a square number, so perhaps a few fewer.
    std::vector<echinus::comparison::JudgedSet> sets(std::size_t count) const;
    /// The same, dealt out to calls of `call_size` particles like cards, so that each call is a small sample
    /// of the set.
    std::vector<echinus::comparison::JudgedSet> sets_for_calls(std::size_t count,
                                                               std::size_t call_size) const;
};

/// The meshes of the comparison, each made on demand: horse_6k, the torus of 2880 faces, armadillo_52k and a
/// torus of about a million faces. Without the folder of development meshes the horse is Debian's, repaired,
/// and the armadillo is left out, with a message on standard error.
std::vector<std::function<Subject()>> subjects(const std::filesystem::path& meshes,
                                               const std::filesystem::path& debian_horse);

/// The first of them.
Subject first_subject(const std::filesystem::path& meshes, const std::filesystem::path& debian_horse);

/// Debian's horse, repaired, and the torus of 2880 faces: meshes that are available to everyone.
Subject public_horse(const std::filesystem::path& debian_horse);
Subject torus_subject();

/// A torus of radii 1 and 0.4 and about this many faces, nearly square in pairs.
echinus::TriangleMesh torus_of(std::size_t face_count);
