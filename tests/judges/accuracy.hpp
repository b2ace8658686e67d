#pragma once

#include "judges/crossing_counter.hpp"
#include "judges/exact_judge.hpp"
#include "judges/judge_trees.hpp"
#include "support/point_sets.hpp"

#include <echinus/exact_map.hpp>

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

/// Judges the answers of an exact map, one particle after the other, without sharing code with the map.
/// docs/accuracy.md explains the figures.
namespace echinus::test {

/// A map's answers about some particles.
struct Answers {
    std::vector<std::uint8_t> inside; ///< of contains_batch()
    std::vector<Contact> contacts;    ///< of contacts_batch(), with an unlimited margin
};

/// The result of one rule on one set of points.
struct Score {
    static constexpr std::size_t kMaxComplaints = 5;

    std::size_t points = 0;
    std::size_t certain = 0;       ///< marked so by the map
    std::size_t ambiguous = 0;     ///< nearer to the surface than 2 lattice steps
    std::size_t wrong_inside = 0;  ///< of the others
    std::size_t wrong_snapped = 0; ///< of all, compared with the snapped particle in the snapped mesh
    /// contains() and contact() disagree, or an answer about a closed surface is uncertain, or a contact is
    /// missing, or its depth has the wrong sign, or its normal is not of length one.
    std::size_t inconsistent = 0;
    double worst_distance_error = 0;   ///< of |depth|, in R
    double worst_point_error = 0;      ///< of the contact point from its face and from its depth, in R
    double worst_normal_error_deg = 0; ///< over particles deeper than 1e-3 R on either side

    // Open surfaces only, where winding numbers are not whole.
    std::size_t far_points = 0;            ///< at least 1 % R from the surface
    std::size_t agreeing = 0;              ///< of those, with |generalised winding number| > 0.5
    std::size_t disagreements_certain = 0; ///< of those, disagreeing yet marked certain

    std::vector<std::string> complaints; ///< the first few faults, each a sentence with the point

    void merge(const Score& later);
    /// Are all sides right and all figures within the limits of docs/accuracy.md?
    bool right(bool closed) const;
};

/// The true answers about one particle.
struct Truth {
    double distance = 0; ///< to the nearest point of the surface
    int winding = 0;     ///< closed surfaces
    /// Of the snapped particle in the snapped mesh. Two values where a coordinate lies halfway between two
    /// lattice planes, up to rounding, so that both neighbours are right.
    std::vector<int> snapped_windings;
    double open_winding = 0; ///< open surfaces, at least 1 % R away
};

/// A map's lattice, with the corners of the mesh's faces on it.
struct SnappedMesh {
    std::vector<Corners> faces;    ///< [face_count] as in the mesh, in lattice steps from the centre
    std::size_t wrong_corners = 0; ///< of the map, more than half a step away from the mesh's
};

/// Snaps a mesh independently of the map, and compares with the map's corners; where a mesh corner lies
/// halfway between two lattice points, the map's choice counts.
SnappedMesh snap_mesh(const TriangleMesh& mesh, const ExactMapView& map);

class AccuracyJudge {
  public:
    AccuracyJudge(const TriangleMesh& mesh, const ExactMapView& map);

    bool closed() const { return closed_; }
    std::size_t wrong_corners() const { return wrong_corners_; }

    /// @param hint  a face that is probably near; it affects the time only
    Truth truth(const Vec3f& point, std::uint32_t hint) const;

    /// Adds one answer to a score.
    void judge(const Vec3f& point, const Truth& truth, InsideRule rule, bool inside, const Contact& contact,
               Score& score) const;

    /// Does this judge agree with CGAL's Side_of_triangle_mesh on a particle? @pre closed()
    bool agrees_with_cgal(const Vec3f& point, const Truth& truth) const;

    std::uint32_t face_count() const { return static_cast<std::uint32_t>(distances_.face_count()); }

  private:
    std::vector<Vec3d> snapped_places(const Vec3f& point) const;
    void judge_side(const Vec3f& point, const Truth& truth, InsideRule rule, bool inside, Score& score) const;
    void judge_open_side(const Vec3f& point, const Truth& truth, bool inside, bool certain,
                         Score& score) const;
    void judge_contact(const Vec3f& point, const Truth& truth, const Contact& contact, Score& score) const;

    Vec3d centre_;
    double radius_, step_;
    bool closed_;
    std::size_t wrong_corners_ = 0;
    DistanceTree distances_;
    std::optional<CrossingCounter> crossings_, snapped_crossings_; ///< closed surfaces
    std::optional<SolidAngleTree> solid_angles_;                   ///< open surfaces
    std::optional<ExactJudge> cgal_;                               ///< closed surfaces
};

/// A rule to be judged: anything that answers.
struct Defendant {
    InsideRule rule = InsideRule::Nonzero;
    std::function<void(std::span<const Vec3f> points, Answers& answers)> ask;
};

struct Verdicts {
    std::vector<Score> scores; ///< one per defendant
    std::size_t compared_with_cgal = 0, judges_disagree = 0;
};

/// Queries all defendants at all points and judges every answer, on several threads; the result does not
/// depend on their number.
/// @param report_progress  called from time to time with the number of points done
Verdicts judge_points(const AccuracyJudge& judge, std::span<const Vec3f> points,
                      std::span<const Defendant> defendants, unsigned thread_count,
                      const std::function<void(std::size_t done)>& report_progress = {});

} // namespace echinus::test
