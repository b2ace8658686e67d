#pragma once

#include "collider/frame_change.hpp"
#include "geometry/workers.hpp"
#include "simulation/surfaces/elements.hpp"
#include "simulation/surfaces/near_elements.hpp"
#include "simulation/surfaces/separation.hpp"
#include "simulation/surfaces/surface_contact.hpp"

#include <echinus/simulation.hpp>

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

namespace echinus {

/// The deformable's own surface, which must not meet itself (docs/surfaces.md).
///
/// All vertices move together, each along a straight way. A pair that a plane separates where they begin, and
/// a plane along the same normal where they end, never meets: its gap along the normal is a concave function
/// of time. Where no such plane remains, the ways of the pair's vertices are shortened.
///
/// Only what is near can meet. Vertices are expected to go on as they move now, and the pairs that would be
/// near then are listed. The list holds for some passes, as long as no vertex is farther than a slack from
/// where it is expected. Around each vertex lies a ball, its *room*: while all stay in
/// their rooms nothing meets, and there is nothing to do. All this is said of motion relative to the mean
/// motion of the particles, which carries everything along.
class SelfSurface {
  public:
    struct Reach {
        float near;      ///< pairs this near along their ways are listed
        float slack;     ///< how far a vertex may be from where it is expected
        float least_gap; ///< no motion takes a pair nearer than this
    };

    /// @param tetrahedra  of which the two sides may lie as near to each other as they are flat
    /// @param thickness  that layers keep from each other, as far as the faces are large enough for it
    SelfSurface(std::shared_ptr<const Elements> own, std::span<const ElasticTetrahedron> tetrahedra,
                const Particles& particles, const Reach& reach, float thickness, float friction);

    /// Keeps pairs so far apart from now on.
    void keep_gap(float least_gap);

    /// Ways are straight in the world, or in a frame that moves.
    /// @param frame  where the frame stands; none: the world
    void begin_pass(const RigidTransform* frame, const PointArrays& starts, bool is_first);
    /// Looks for contacts on the way to the goals. @param frame  at the end of the frame
    void look_ahead(const RigidTransform* frame, const PointArrays& goals, const Workers& workers);
    void relax(Particles& particles, std::span<const float> inverse_masses, SimulationProfile& profile);

    /// Where vertices end that go none of their ways. What is pinned goes all of its way.
    struct Bases {
        static constexpr std::uint32_t kAlone = std::numeric_limits<std::uint32_t>::max();
        static constexpr std::uint32_t kStaying = kAlone - 1; ///< left where it is in the frame

        PointArrays places;
        std::vector<std::uint32_t> bodies; ///< by vertex: what has one number goes there as one rigid body
    };

    /// Could pairs meet on the way to the goals? If not, all may go the whole way.
    bool may_meet(const RigidTransform* frame, const PointArrays& goals, const Workers& workers);
    /// The shares of the ways to the goals that vertices may go. @pre may_meet()
    std::span<const float> allowed_shares(const RigidTransform* frame, const Bases& bases,
                                          const Workers& workers);
    /// Pairs that could meet nevertheless, since a vertex is led on, or pinned, while others stay behind.
    std::span<const std::array<std::uint32_t, 4>> stuck() const { return stuck_; }

    void archive(StateArchive& state);

    std::uint64_t searched_count = 0, measured_count = 0;

  private:
    struct Contact {
        SurfaceContact pair;
        bool has_pushed = false;
    };

    void to_frame(const RigidTransform* frame, const PointArrays& places, PointArrays& result);
    void set_goals(const RigidTransform* frame, const PointArrays& goals);
    bool all_within(std::span<const float> radii) const;

    void list_pairs(const Workers& workers);
    Vec3f expected(std::uint32_t vertex, bool at_end) const;
    Vec3f expected_in(std::uint32_t vertex, std::uint32_t frame) const;
    bool is_elsewhere(std::uint32_t vertex) const;
    void expect(std::uint32_t vertex);
    void set_window(const Workers& workers);
    void want(bool all, const Workers& workers);
    void refit_trees(const Workers& workers);
    std::uint32_t frames_to_list() const;
    bool has_moved(const Element& element) const;
    /// What a worker needs to search.
    struct Search {
        std::vector<std::array<std::uint32_t, 2>> near;
        std::vector<Pair> candidates;
        std::vector<Separation> separations;
    };
    void search(const Workers& workers);
    void search_piece(std::size_t piece, Search& search) const;
    void add_vertex_face(std::uint32_t vertex, std::uint32_t face, std::vector<Pair>& candidates) const;
    void add_edge_edge(std::uint32_t a, std::uint32_t b, std::vector<Pair>& candidates) const;
    void keep_near(Search& search, std::vector<Pair>& found) const;

    void measure(const Workers& workers);
    template <typename RadiusOf>
    void lessen(std::vector<float>& radii, float most, const Workers& workers, const RadiusOf& radius_of);
    float thickness_of(const Pair& pair) const;
    float closing(const Pair& pair, const Separation& apart) const;
    bool slides_past(const Pair& pair, const Separation& apart, float thickness) const;
    float consider(const Pair& pair, const Separation& apart, std::vector<Contact>& contacts) const;
    /// How a pair would end by the present shares.
    struct Ending {
        float kept;            ///< of its gap, at least
        float at_end, at_base; ///< its gap
        bool stays;            ///< as far apart where its vertices go none of their ways
    };
    Ending ending_of(std::size_t pair) const;
    bool is_led_as_one(std::size_t pair) const;
    bool is_apart(std::size_t pair, const Ending& ending) const {
        return separations_[pair].gap > 0 && ending.at_end >= ending.kept;
    }
    void find_meeting(const Workers& workers);
    bool stays_apart(const Pair& pair) const;
    bool shorten_ways(int round, const Workers& workers);
    Vec3f place_at_share(std::uint32_t vertex) const;

    std::shared_ptr<const Elements> own_;
    std::vector<Element> faces_, edges_; ///< each as elements of their own
    std::vector<std::uint32_t> surface_; ///< the vertices that have elements
    std::vector<Element> vertices_;      ///< these as elements
    MovingTree face_tree_, edge_tree_, vertex_tree_;
    Reach reach_;
    float thickness_, friction_;
    std::vector<float> most_;     ///< by vertex: the most thickness that what is around it allows
    std::vector<float> mobility_; ///< by vertex: 1, or 0 for one that is pinned
    // The frame
    FrameChange now_{RigidTransform{}, {1, 1, 1}};
    bool in_world_ = true;
    PointArrays starts_, goals_; ///< less the drift when the pass began
    Vec3f drift_;                ///< the mean motion when the pass began
    Vec3f drifting_;             ///< in this pass
    // Pairs, each once, with the one side as the deformable's and the other as the opponent's
    bool has_searched_ = false;
    bool is_first_pass_ = true; ///< of this frame
    std::uint32_t frame_number_ = 0;
    std::uint32_t first_frame_ = 0, last_frame_ = 0; ///< from the start of the one to the end of the other,
                                                     ///< pairs are listed
    bool has_window_ = false;                        ///< the trees stand for these frames
    PointArrays expected_, speeds_; ///< where vertices were when their pairs were listed, and how they move
                                    ///< in a frame, less the drift
    std::vector<std::uint32_t> listed_in_;         ///< by vertex: the frame
    std::vector<std::uint8_t> is_listed_for_pass_; ///< by vertex
    PointArrays from_, to_;                        ///< expected at both ends of these frames
    std::vector<std::uint8_t> has_moved_;          ///< by vertex, while they are listed
    std::vector<Pair> pairs_;
    std::vector<Separation> separations_;
    std::vector<Search> searches_; ///< by worker
    PiecewiseList<Pair> found_;
    // Rooms
    PointArrays anchors_;                      ///< less the drift
    std::vector<float> rooms_, quiet_;         ///< radii; within the quiet ones no contact begins or changes
    bool is_measured_ = false;                 ///< in this pass
    std::vector<std::vector<float>> lessened_; ///< by worker: radii
    std::vector<float> shares_;
    std::vector<std::uint8_t> meets_;         ///< by pair, as the ways are when a round begins
    std::vector<std::uint8_t> was_shortened_; ///< by vertex, in this round
    PointArrays bases_;                       ///< at a share of 0
    std::span<const std::uint32_t> bodies_;   ///< by vertex, as Bases has them
    PointArrays whole_goals_;                 ///< before any way was shortened
    std::vector<std::array<std::uint32_t, 4>> stuck_;
    // Contacts
    std::vector<Contact> contacts_;
    PiecewiseList<Contact> contacts_found_;
    std::vector<std::uint8_t> is_alert_; ///< by vertex: a contact has pushed it lately
};

} // namespace echinus
