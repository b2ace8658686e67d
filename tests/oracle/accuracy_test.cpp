// Would the judge of exact maps notice a wrong answer? A box gives true answers by formula; each test spoils
// them in one way and expects that fault in the score and no other.

#include "directions/lattice.hpp"
#include "judges/accuracy.hpp"
#include "judges/nasty_meshes.hpp"
#include "support/point_sets.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

using namespace echinus;

namespace {

/// All that the judge reads from a map itself: the position of its lattice.
ExactMapView lattice_around(const TriangleMesh& mesh) {
    const LatticeMesh lattice = snap_to_lattice(mesh);
    ExactMapView view;
    view.centre = lattice.centre;
    view.radius = lattice.radius;
    view.divisions = 16;
    return view;
}

/// Answers for the box [-1, 1]^3 by formula.
class BoxFormula {
  public:
    BoxFormula() {
        for (const auto& [a, b, c] : mesh.faces)
            faces_.push_back({Vec3d(mesh.vertices[a]), Vec3d(mesh.vertices[b]), Vec3d(mesh.vertices[c])});
    }

    Contact contact(const Vec3f& point) const {
        const Vec3d p(point);
        Contact contact;
        contact.inside = std::max({std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)}) < 1;
        const Vec3d nearest = contact.inside ? on_nearest_side(p) : clamped(p);
        const Vec3d out = contact.inside ? nearest - p : p - nearest;
        contact.point = Vec3f(nearest);
        contact.depth = static_cast<float>((contact.inside ? 1 : -1) * length(out));
        contact.normal = Vec3f(out * (1 / length(out)));
        contact.face = face_at(nearest);
        return contact;
    }

    const TriangleMesh mesh = make_box({2, 2, 2}, 3);

  private:
    static Vec3d clamped(const Vec3d& p) {
        return {std::clamp(p.x, -1.0, 1.0), std::clamp(p.y, -1.0, 1.0), std::clamp(p.z, -1.0, 1.0)};
    }
    static Vec3d on_nearest_side(Vec3d p) {
        double& largest = std::ranges::max({std::ref(p.x), std::ref(p.y), std::ref(p.z)}, {},
                                           [](double& v) { return std::fabs(v); });
        largest = std::copysign(1, largest);
        return p;
    }
    std::uint32_t face_at(const Vec3d& place) const {
        const auto face = std::ranges::min_element(
            faces_, {}, [&](const test::Corners& corners) { return test::distance_to(corners, place); });
        return static_cast<std::uint32_t>(face - faces_.begin());
    }

    std::vector<test::Corners> faces_;
};

/// Judges the box's formula, with one answer of the thousand spoilt by `spoil`.
template <typename Spoil>
test::Score score_of_spoilt(const Spoil& spoil, InsideRule rule = InsideRule::Nonzero) {
    constexpr std::size_t kCount = 1000, kSpoilt = 400;
    const BoxFormula box;
    const test::AccuracyJudge judge(box.mesh, lattice_around(box.mesh));
    const std::vector<Vec3f> points = test::uniform_points(box.mesh, kCount);
    const test::Defendant defendant{rule, [&](std::span<const Vec3f> asked, test::Answers& answers) {
                                        answers = {};
                                        for (const Vec3f& p : asked) {
                                            answers.contacts.push_back(box.contact(p));
                                            answers.inside.push_back(answers.contacts.back().inside ? 1 : 0);
                                        }
                                        spoil(answers.inside[kSpoilt], answers.contacts[kSpoilt]);
                                    }};
    const test::Verdicts verdicts = judge_points(judge, points, std::span(&defendant, 1), 2);
    EXPECT_EQ(verdicts.judges_disagree, 0U);
    EXPECT_EQ(verdicts.scores.front().points, kCount);
    return verdicts.scores.front();
}

} // namespace

TEST(AccuracyJudge, FindsNoFaultInTrueAnswers) {
    for (const InsideRule rule : {InsideRule::Nonzero, InsideRule::Parity}) {
        const test::Score score = score_of_spoilt([](std::uint8_t&, Contact&) {}, rule);
        EXPECT_TRUE(score.right(true));
        EXPECT_TRUE(score.complaints.empty()) << score.complaints.front();
        EXPECT_LT(score.worst_distance_error, 1e-6);
        EXPECT_LT(score.worst_normal_error_deg, 0.01);
    }
}

TEST(AccuracyJudge, CountsAWrongSide) {
    const test::Score score = score_of_spoilt([](std::uint8_t& inside, Contact& contact) {
        contact.inside = !contact.inside;
        contact.depth = -contact.depth;
        contact.normal = -contact.normal;
        inside = contact.inside ? 1 : 0;
    });
    EXPECT_EQ(score.wrong_inside, 1U);
    EXPECT_EQ(score.wrong_snapped, 1U);
    EXPECT_EQ(score.inconsistent, 0U);
    EXPECT_EQ(score.complaints.size(), 2U);
    EXPECT_FALSE(score.right(true));
}

TEST(AccuracyJudge, CountsQueriesThatDisagree) {
    const test::Score score =
        score_of_spoilt([](std::uint8_t&, Contact& contact) { contact.inside = !contact.inside; });
    EXPECT_EQ(score.wrong_inside, 0U);
    EXPECT_EQ(score.inconsistent, 2U); // the depth's sign is wrong now as well
}

TEST(AccuracyJudge, CountsMissingContactsAndNormalsThatAreNotANumber) {
    EXPECT_EQ(score_of_spoilt([](std::uint8_t&, Contact& c) { c.face = kNoIndex; }).inconsistent, 1U);
    EXPECT_EQ(score_of_spoilt([](std::uint8_t&, Contact& c) { c.normal.y = NAN; }).inconsistent, 1U);
    EXPECT_EQ(score_of_spoilt([](std::uint8_t&, Contact& c) { c.depth = NAN; }).inconsistent, 1U);
}

TEST(AccuracyJudge, MeasuresAWrongDistance) {
    const test::Score score =
        score_of_spoilt([](std::uint8_t&, Contact& contact) { contact.depth *= 1.01F; });
    EXPECT_GT(score.worst_distance_error, 1e-5);
    EXPECT_GT(score.worst_point_error, 1e-5);
    EXPECT_FALSE(score.right(true));
}

TEST(AccuracyJudge, MeasuresAContactPointThatIsNotTheNearest) {
    const test::Score score = score_of_spoilt([](std::uint8_t&, Contact& contact) {
        contact.point.x += 0.01F; // possibly in the side's plane, but not where the depth leads
        contact.point.y += 0.01F;
    });
    EXPECT_LT(score.worst_distance_error, 1e-6);
    EXPECT_GT(score.worst_point_error, 1e-5);
    EXPECT_FALSE(score.right(true));
}

TEST(AccuracyJudge, MeasuresAWrongNormal) {
    const test::Score score = score_of_spoilt([](std::uint8_t&, Contact& contact) {
        contact.normal = Vec3f(Rotation::about({1, 2, 3}, 0.01).apply(Vec3d(contact.normal)));
    });
    EXPECT_GT(score.worst_normal_error_deg, 0.1);
    EXPECT_LT(score.worst_normal_error_deg, 0.6);
    EXPECT_FALSE(score.right(true));
}

TEST(AccuracyJudge, ForgivesOnlyPointsNearTheSurface) {
    const BoxFormula box;
    const ExactMapView lattice = lattice_around(box.mesh);
    const test::AccuracyJudge judge(box.mesh, lattice);
    const auto score_of = [&](float steps_outside) {
        const Vec3f point{1 + steps_outside * lattice.radius * 0x1p-19F, 0.25F, 0.3F};
        test::Score score;
        Contact contact = box.contact(point);
        contact.inside = true; // which it is not
        judge.judge(point, judge.truth(point, 0), InsideRule::Nonzero, true, contact, score);
        return score;
    };
    EXPECT_EQ(score_of(1).ambiguous, 1U);
    EXPECT_EQ(score_of(1).wrong_inside, 0U);
    EXPECT_EQ(score_of(1).wrong_snapped, 1U);
    EXPECT_EQ(score_of(3).ambiguous, 0U);
    EXPECT_EQ(score_of(3).wrong_inside, 1U);
}

TEST(AccuracyJudge, JudgesOpenSurfacesByTheirWindingNumber) {
    TriangleMesh open = make_sphere(1, 40, 20);
    open.faces.resize(open.faces.size() - 200);
    const test::AccuracyJudge judge(open, lattice_around(open));
    ASSERT_FALSE(judge.closed());
    const Vec3f centre{0, 0, 0};
    const auto score_of = [&](bool inside, bool certain) {
        test::Score score;
        Contact contact;
        contact.inside = inside;
        contact.certain = certain;
        judge.judge(centre, judge.truth(centre, 0), InsideRule::Nonzero, inside, contact, score);
        return score;
    };
    EXPECT_EQ(score_of(true, true).agreeing, 1U);
    EXPECT_EQ(score_of(true, true).certain, 1U);
    EXPECT_EQ(score_of(false, false).agreeing, 0U);
    EXPECT_EQ(score_of(false, false).disagreements_certain, 0U);
    EXPECT_EQ(score_of(false, true).disagreements_certain, 1U);
}

TEST(AccuracyJudge, FindsCornersThatAreNotWhereTheMeshIs) {
    const TriangleMesh box = make_box({2, 2, 2});
    const LatticeMesh lattice = snap_to_lattice(box);
    std::vector<Vec3<std::int32_t>> vertices;
    for (const LatticePoint& v : lattice.vertices) vertices.emplace_back(v);
    std::vector<std::uint16_t> corners, numbers;
    for (std::size_t i = 0; i < box.faces.size(); ++i) {
        numbers.push_back(static_cast<std::uint16_t>(i));
        for (const std::uint32_t corner : box.faces[i]) corners.push_back(static_cast<std::uint16_t>(corner));
    }
    ExactMapView view = lattice_around(box);
    view.vertices = vertices;
    view.corners.narrow = corners;
    view.face_numbers.narrow = numbers;
    EXPECT_EQ(test::snap_mesh(box, view).wrong_corners, 0U);
    vertices[2].y += 2;
    EXPECT_EQ(test::snap_mesh(box, view).wrong_corners,
              static_cast<std::size_t>(std::ranges::count(corners, 2)));
}
