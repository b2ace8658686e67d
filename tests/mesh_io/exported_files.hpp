#pragma once

#include <echinus/mesh.hpp>

#include <array>
#include <filesystem>
#include <string>

namespace echinus::test {

/// A kind of file that Assimp can write: its exporter's name and the extension of the file's name.
struct ExportedKind {
    const char* exporter;
    const char* ending;
};

inline constexpr std::array<ExportedKind, 8> kExportedKinds{{{"obj", ".obj"},
                                                             {"stl", ".stl"},
                                                             {"stlb", ".stl"},
                                                             {"ply", ".ply"},
                                                             {"plyb", ".ply"},
                                                             {"gltf2", ".gltf"},
                                                             {"glb2", ".glb"},
                                                             {"3ds", ".3ds"}}};

/// Rows of a 3 x 4 matrix: the place of a mesh in the file's scene.
using Placement = std::array<float, 12>;
inline constexpr Placement kInPlace{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};

/// False where the tests were built without Assimp: then those that export skip themselves.
bool can_export();
inline constexpr const char* kCannotExport = "these tests were built without Assimp";

/// Writes the mesh with Assimp's exporter, in a node with this placement.
void export_with_assimp(const std::filesystem::path& path, const TriangleMesh& mesh, const ExportedKind& kind,
                        const Placement& placement = kInPlace);

} // namespace echinus::test
