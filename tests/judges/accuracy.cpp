#include "judges/accuracy.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <mutex>
#include <numbers>
#include <thread>

namespace echinus::test {

namespace {

constexpr double kAmbiguousSteps = 2;   // snapping moves mesh and particle by sqrt(3) steps together
constexpr double kDeep = 1e-3;          // R; nearer, snapping turns directions by more than the stated limit
constexpr double kFar = 0.01;           // R, for open surfaces
constexpr double kDistanceLimit = 1e-5; // R
constexpr double kNormalLimitDeg = 0.1;
constexpr double kUnitLength = 1e-5;
/// Within this distance of halfway between two lattice planes, in steps, either is right: the rounding of
/// double on the way from float to lattice.
constexpr double kTie = 1e-6;

std::vector<Corners> corners_of(const TriangleMesh& mesh) {
    std::vector<Corners> corners;
    corners.reserve(mesh.faces.size());
    for (const auto& [a, b, c] : mesh.faces)
        corners.push_back({Vec3d(mesh.vertices[a]), Vec3d(mesh.vertices[b]), Vec3d(mesh.vertices[c])});
    return corners;
}

double step_of(const ExactMapView& map) {
    return static_cast<double>(map.radius) * 0x1p-19;
}

Vec3d rounded(const Vec3d& p) {
    return {std::round(p.x), std::round(p.y), std::round(p.z)};
}

double largest_component(const Vec3d& v) {
    return std::max({std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)});
}

bool is_inside(InsideRule rule, int winding) {
    return rule == InsideRule::Nonzero ? winding != 0 : winding % 2 != 0;
}

double angle_deg(const Vec3d& a, const Vec3d& b) {
    return std::atan2(length(cross(a, b)), dot(a, b)) * 180 / std::numbers::pi;
}

/// The error of a position that was rounded to float.
double rounding_of(const Vec3f& rounded_place) {
    const auto half_spacing = [](float x) {
        return 0.5 * static_cast<double>(std::nextafter(std::fabs(x), INFINITY) - std::fabs(x));
    };
    return length(
        Vec3d{half_spacing(rounded_place.x), half_spacing(rounded_place.y), half_spacing(rounded_place.z)});
}

void complain(Score& score, const Vec3f& p, const std::string& what) {
    if (score.complaints.size() < Score::kMaxComplaints)
        score.complaints.push_back(fmt::format("({}, {}, {}): {}", p.x, p.y, p.z, what));
}

/// Counts and describes a fault.
void count(std::size_t& counter, Score& score, const Vec3f& point, const std::string& what) {
    ++counter;
    complain(score, point, what);
}

} // namespace

void Score::merge(const Score& later) {
    points += later.points;
    ambiguous += later.ambiguous;
    wrong_inside += later.wrong_inside;
    wrong_snapped += later.wrong_snapped;
    inconsistent += later.inconsistent;
    worst_distance_error = std::max(worst_distance_error, later.worst_distance_error);
    worst_point_error = std::max(worst_point_error, later.worst_point_error);
    worst_normal_error_deg = std::max(worst_normal_error_deg, later.worst_normal_error_deg);
    far_points += later.far_points;
    agreeing += later.agreeing;
    disagreements_certain += later.disagreements_certain;
    certain += later.certain;
    for (const std::string& complaint : later.complaints)
        if (complaints.size() < kMaxComplaints) complaints.push_back(complaint);
}

bool Score::right(bool closed) const {
    const bool sides = closed ? wrong_inside == 0 && wrong_snapped == 0
                              : disagreements_certain == 0 &&
                                    static_cast<double>(agreeing) >= 0.999 * static_cast<double>(far_points);
    return sides && inconsistent == 0 && worst_distance_error <= kDistanceLimit &&
           worst_point_error <= kDistanceLimit && worst_normal_error_deg <= kNormalLimitDeg;
}

SnappedMesh snap_mesh(const TriangleMesh& mesh, const ExactMapView& map) {
    SnappedMesh snapped{corners_of(mesh), 0};
    const auto to_lattice = [&](const Vec3d& p) { return (p - Vec3d(map.centre)) * (1 / step_of(map)); };
    std::vector<Corners> unrounded = snapped.faces;
    for (Corners& face : unrounded)
        for (Vec3d& corner : face) corner = to_lattice(corner);
    for (std::size_t i = 0; i < unrounded.size(); ++i)
        std::ranges::transform(unrounded[i], snapped.faces[i].begin(), rounded);
    for (std::size_t i = 0; i < map.face_count(); ++i)
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t face = map.face_numbers[i];
            const Vec3d corner(map.vertices[map.corners[3 * i + k]]);
            if (largest_component(corner - unrounded[face][k]) <= 0.5 + kTie)
                snapped.faces[face][k] = corner;
            else
                ++snapped.wrong_corners;
        }
    return snapped;
}

AccuracyJudge::AccuracyJudge(const TriangleMesh& mesh, const ExactMapView& map)
    : centre_(map.centre), radius_(static_cast<double>(map.radius)), step_(step_of(map)),
      closed_(inspect(weld(mesh)).closed), distances_(corners_of(mesh)) {
    SnappedMesh snapped = snap_mesh(mesh, map);
    wrong_corners_ = snapped.wrong_corners;
    if (!closed_) {
        solid_angles_.emplace(mesh);
        return;
    }
    crossings_.emplace(corners_of(mesh), step_, OnPlane::Skip);
    snapped_crossings_.emplace(std::move(snapped.faces), 1, OnPlane::Displace);
    cgal_.emplace(mesh);
}

/// The lattice points of a particle: more than one where a coordinate lies halfway between two.
std::vector<Vec3d> AccuracyJudge::snapped_places(const Vec3f& point) const {
    const Vec3d p = (Vec3d(point) - centre_) * (1 / step_);
    const Vec3d low = rounded(p - Vec3d{kTie, kTie, kTie}), high = rounded(p + Vec3d{kTie, kTie, kTie});
    if (low == high) return {low};
    std::vector<Vec3d> places;
    for (const double x : {low.x, high.x})
        for (const double y : {low.y, high.y})
            for (const double z : {low.z, high.z})
                if (std::ranges::find(places, Vec3d{x, y, z}) == places.end()) places.emplace_back(x, y, z);
    return places;
}

Truth AccuracyJudge::truth(const Vec3f& point, std::uint32_t hint) const {
    const Vec3d p(point);
    Truth truth;
    truth.distance = distances_.distance(p, hint);
    if (closed_) {
        truth.winding = crossings_->winding(p);
        for (const Vec3d& place : snapped_places(point))
            truth.snapped_windings.push_back(snapped_crossings_->winding(place));
    } else if (truth.distance >= kFar * radius_) {
        truth.open_winding = solid_angles_->winding_number(p); // expensive, and not needed elsewhere
    }
    return truth;
}

bool AccuracyJudge::agrees_with_cgal(const Vec3f& point, const Truth& truth) const {
    const ExactSide side = cgal_->side(Vec3d(point));
    return side == ExactSide::OnSurface || (side == ExactSide::Inside) == (truth.winding % 2 != 0);
}

void AccuracyJudge::judge_side(const Vec3f& point, const Truth& truth, InsideRule rule, bool inside,
                               Score& score) const {
    if (truth.distance < kAmbiguousSteps * step_)
        ++score.ambiguous;
    else if (inside != is_inside(rule, truth.winding))
        count(score.wrong_inside, score, point,
              fmt::format("winding number {}, {:.3g} R from the surface, answered {}", truth.winding,
                          truth.distance / radius_, inside ? "inside" : "outside"));
    const bool right = std::ranges::any_of(truth.snapped_windings,
                                           [&](int winding) { return inside == is_inside(rule, winding); });
    if (!right)
        count(score.wrong_snapped, score, point,
              fmt::format("winding number {} after snapping, answered {}", truth.snapped_windings.front(),
                          inside ? "inside" : "outside"));
}

void AccuracyJudge::judge_open_side(const Vec3f& point, const Truth& truth, bool inside, bool certain,
                                    Score& score) const {
    if (truth.distance < kAmbiguousSteps * step_) ++score.ambiguous;
    if (truth.distance < kFar * radius_) return;
    ++score.far_points;
    if (inside == (std::fabs(truth.open_winding) > 0.5))
        ++score.agreeing;
    else if (certain)
        count(score.disagreements_certain, score, point,
              fmt::format("generalised winding number {:.6f}, answered {} and certain", truth.open_winding,
                          inside ? "inside" : "outside"));
}

void AccuracyJudge::judge_contact(const Vec3f& point, const Truth& truth, const Contact& contact,
                                  Score& score) const {
    const Vec3d normal(contact.normal);
    if (contact.face >= face_count() || !(std::fabs(length(normal) - 1) <= kUnitLength) ||
        !is_finite(contact.point))
        return count(score.inconsistent, score, point, "no contact, or its normal has not length one");
    const double depth = static_cast<double>(contact.depth);
    if (!(contact.inside ? depth >= 0 : depth <= 0))
        return count(score.inconsistent, score, point, "the depth has the wrong sign or is not a number");
    const Vec3d to_surface = Vec3d(contact.point) - Vec3d(point);
    const Corners& face = distances_.face(contact.face);
    const double distance_error = std::fabs(std::fabs(depth) - truth.distance) / radius_;
    const double point_error =
        std::max(distance_to(face, Vec3d(contact.point)), std::fabs(length(to_surface) - std::fabs(depth))) /
        radius_;
    score.worst_distance_error = std::max(score.worst_distance_error, distance_error);
    score.worst_point_error = std::max(score.worst_point_error, point_error);
    if (distance_error > kDistanceLimit || point_error > kDistanceLimit)
        complain(score, point,
                 fmt::format("distance wrong by {:.3g} R, contact point by {:.3g} R", distance_error,
                             point_error));
    if (truth.distance <= kDeep * radius_) return;
    // Far from the origin, the contact point is coarser than the normal.
    const double by_rounding = rounding_of(contact.point) / truth.distance * 180 / std::numbers::pi;
    const double angle =
        std::max(0.0, angle_deg(normal, contact.inside ? to_surface : -to_surface) - by_rounding);
    score.worst_normal_error_deg = std::max(score.worst_normal_error_deg, angle);
    if (angle > kNormalLimitDeg) complain(score, point, fmt::format("normal wrong by {:.3g} degrees", angle));
}

void AccuracyJudge::judge(const Vec3f& point, const Truth& truth, InsideRule rule, bool inside,
                          const Contact& contact, Score& score) const {
    ++score.points;
    if (inside != contact.inside)
        count(score.inconsistent, score, point, "contains() and contact() put it on different sides");
    score.certain += contact.certain ? 1 : 0;
    if (closed_ && !contact.certain)
        count(score.inconsistent, score, point, "called uncertain, though the surface is closed");
    if (closed_)
        judge_side(point, truth, rule, inside, score);
    else
        judge_open_side(point, truth, inside, contact.certain, score);
    judge_contact(point, truth, contact, score);
}

// Judges many points on several threads.

namespace {

constexpr std::size_t kBatch = 8192;
/// Side_of_triangle_mesh takes many times as long as everything else.
constexpr std::size_t kComparedWithCgal = 256;

Verdicts judge_batch(const AccuracyJudge& judge, std::span<const Vec3f> points,
                     std::span<const Defendant> defendants) {
    Verdicts verdicts;
    verdicts.scores.resize(defendants.size());
    std::vector<Answers> answers(defendants.size());
    for (std::size_t d = 0; d < defendants.size(); ++d) defendants[d].ask(points, answers[d]);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const std::uint32_t face = answers.empty() ? 0 : answers.front().contacts[i].face;
        const Truth truth = judge.truth(points[i], face < judge.face_count() ? face : 0);
        for (std::size_t d = 0; d < defendants.size(); ++d)
            judge.judge(points[i], truth, defendants[d].rule, answers[d].inside[i] != 0,
                        answers[d].contacts[i], verdicts.scores[d]);
        if (!judge.closed() || i % kComparedWithCgal != 0) continue;
        ++verdicts.compared_with_cgal;
        verdicts.judges_disagree += judge.agrees_with_cgal(points[i], truth) ? 0 : 1;
    }
    return verdicts;
}

/// Calls body(i) for i in [0, count) on several threads; the first exception reaches the caller.
template <typename Body>
void on_threads(std::size_t count, unsigned thread_count, const Body& body) {
    std::atomic<std::size_t> next{0};
    std::exception_ptr failure;
    std::mutex failure_mutex;
    const auto work = [&] {
        try {
            for (std::size_t i = next++; i < count; i = next++) body(i);
        } catch (...) {
            const std::lock_guard lock(failure_mutex);
            if (!failure) failure = std::current_exception();
            next = count;
        }
    };
    {
        std::vector<std::jthread> helpers;
        for (unsigned i = 1; i < thread_count; ++i) helpers.emplace_back(work);
        work();
    }
    if (failure) std::rethrow_exception(failure);
}

} // namespace

Verdicts judge_points(const AccuracyJudge& judge, std::span<const Vec3f> points,
                      std::span<const Defendant> defendants, unsigned thread_count,
                      const std::function<void(std::size_t done)>& report_progress) {
    const std::size_t batch_count = (points.size() + kBatch - 1) / kBatch;
    std::vector<Verdicts> batches(batch_count); // merged in order, so that the complaints are the first
                                                // overall
    std::mutex progress_mutex;
    std::size_t done = 0;
    on_threads(batch_count,
               std::max(1U, thread_count != 0 ? thread_count : std::thread::hardware_concurrency()),
               [&](std::size_t i) {
                   const std::size_t first = i * kBatch;
                   const auto batch = points.subspan(first, std::min(kBatch, points.size() - first));
                   batches[i] = judge_batch(judge, batch, defendants);
                   const std::lock_guard lock(progress_mutex);
                   done += batch.size();
                   if (report_progress) report_progress(done);
               });
    Verdicts total;
    total.scores.resize(defendants.size());
    for (const Verdicts& batch : batches) {
        for (std::size_t d = 0; d < defendants.size(); ++d) total.scores[d].merge(batch.scores[d]);
        total.compared_with_cgal += batch.compared_with_cgal;
        total.judges_disagree += batch.judges_disagree;
    }
    return total;
}

} // namespace echinus::test
