#pragma once

#include "oracle/exact_judge.hpp"
#include "rivals/compare/point_sets.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

/// A set of points and, for each, what is true of it.
struct JudgedPoints {
    std::string name;
    std::vector<echinus::Vec3f> points;
    std::vector<std::uint8_t> inside; ///< [point_count] by CGAL's exact predicates
};

/// Asks the judge about every point.
JudgedPoints judged(std::string name, std::vector<echinus::Vec3f> points,
                    const echinus::test::ExactJudge& judge);

/// A model that the paper's map is measured on.
struct Subject {
    std::string name;
    std::string origin; ///< a clause for the page: where the model is from
    echinus::TriangleMesh mesh;
    echinus::comparison::Axis up;
    std::size_t side_count; ///< C has side_count x side_count points, U and S as many
    double radius;          ///< of the bounding sphere
    echinus::test::ExactJudge judge;
    std::array<JudgedPoints, 3> sets; ///< U, S and C

    Subject(std::string name, std::string origin, echinus::TriangleMesh mesh, echinus::comparison::Axis up,
            std::size_t side_count);
};
