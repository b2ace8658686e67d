#pragma once

#include <echinus/error.hpp>
#include <echinus/mesh.hpp>

#include <gtest/gtest.h>

#include <cstddef>
#include <string>

namespace echinus::test {

/// The sentence of the Error that the call throws, which must have this code; empty where it throws none.
template <typename Call>
std::string refusal_of(ErrorCode code, Call&& call) {
    try {
        call();
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), code) << error.what();
        return error.what();
    }
    return "";
}

inline void expect_words(const std::string& sentence, const std::string& words) {
    EXPECT_NE(sentence.find(words), std::string::npos) << "expected \"" << words << "\" in: " << sentence;
}

/// The call must throw an Error with this code whose sentence contains these words.
template <typename Call>
void expect_error(ErrorCode code, const std::string& words, Call&& call) {
    const std::string sentence = refusal_of(code, call);
    if (sentence.empty())
        ADD_FAILURE() << "no error was thrown; expected one with \"" << words << "\"";
    else
        expect_words(sentence, words);
}

/// Expects the corners at the same positions in the file's frame, face by face and up to a distance, whatever
/// the order of the vertices.
inline void expect_same_faces(const TriangleMesh& mesh, const TriangleMesh& expected, double tolerance = 0) {
    ASSERT_EQ(mesh.faces.size(), expected.faces.size());
    for (std::size_t face = 0; face < mesh.faces.size(); ++face)
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const Vec3d found = mesh.origin + Vec3d(mesh.vertices[mesh.faces[face][corner]]);
            const Vec3d sought = expected.origin + Vec3d(expected.vertices[expected.faces[face][corner]]);
            ASSERT_LE(length(found - sought), tolerance) << "corner " << corner << " of face " << face;
        }
}

} // namespace echinus::test
