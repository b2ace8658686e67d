#include "simulation/start/validation.hpp"

#include <echinus/error.hpp>
#include <echinus/simulation.hpp>

#include <cmath>
#include <string>

namespace echinus {

namespace {

void require(bool condition, const std::string& sentence) {
    if (!condition) throw Error(ErrorCode::InvalidOptions, sentence);
}

/// 16 million particles: 1 GB of particles and constraints.
constexpr std::uint64_t kMaxParticleCount = std::uint64_t{1} << 24;

void require_possible(const ClothOptions& options) {
    const std::uint64_t particle_count = std::uint64_t{options.column_count} * options.row_count;
    require(options.column_count >= 2 && options.row_count >= 2 && particle_count <= kMaxParticleCount,
            "a cloth of " + std::to_string(options.column_count) + " x " + std::to_string(options.row_count) +
                " particles is not possible; use at least 2 x 2 and at most " +
                std::to_string(kMaxParticleCount) + " in all");
    require(std::isfinite(options.width) && options.width > 0 && std::isfinite(options.height) &&
                options.height > 0,
            "the width and height of a cloth must be positive and finite; they are " +
                std::to_string(options.width) + " and " + std::to_string(options.height));
    require_valid(options.pose, "the cloth");
    for (const std::uint32_t pin : options.pins)
        require(pin < particle_count, "the cloth has no particle " + std::to_string(pin) +
                                          " to pin; its last one is " + std::to_string(particle_count - 1));
}

/// Makes the particles, constraints and faces of a sheet.
class Weaver {
  public:
    explicit Weaver(const ClothOptions& options)
        : options_(options), columns_(options.column_count), rows_(options.row_count) {}

    Deformable weave() {
        for (std::uint32_t row = 0; row < rows_; ++row) {
            add_particles(row);
            add_constraints_along(row);
            if (row >= 1) add_constraints_to_previous(row);
            if (row >= 2) add_constraints_across(row);
        }
        for (const std::uint32_t pin : options_.pins) cloth_.inverse_masses[pin] = 0;
        return std::move(cloth_);
    }

  private:
    std::uint32_t index(std::uint32_t row, std::uint32_t column) const { return row * columns_ + column; }

    void add_particles(std::uint32_t row) {
        for (std::uint32_t column = 0; column < columns_; ++column) {
            const Vec3d local{options_.width * (double(column) / (columns_ - 1) - 0.5),
                              options_.height * (double(row) / (rows_ - 1) - 0.5), 0};
            cloth_.positions.emplace_back(options_.pose.to_world(local));
            cloth_.inverse_masses.push_back(1);
        }
    }

    void add_constraint(std::uint32_t a, std::uint32_t b, ConstraintKind kind) {
        const Vec3d across = Vec3d(cloth_.positions[b]) - Vec3d(cloth_.positions[a]);
        cloth_.constraints.push_back({a, b, static_cast<float>(length(across)), kind});
    }

    /// The constraints of one row. Neighbouring constraints share a particle, so every second one is added
    /// first.
    void add_constraints_along(std::uint32_t row) {
        for (std::uint32_t first : {0U, 1U})
            for (std::uint32_t column = first; column + 1 < columns_; column += 2)
                add_constraint(index(row, column), index(row, column + 1), ConstraintKind::Structural);
        for (std::uint32_t first : {0U, 2U})
            for (std::uint32_t column = first; column + 2 < columns_; column += column % 2 == 0 ? 1 : 3)
                add_constraint(index(row, column), index(row, column + 2), ConstraintKind::Bending);
    }

    void add_constraints_to_previous(std::uint32_t row) {
        for (std::uint32_t column = 0; column < columns_; ++column)
            add_constraint(index(row - 1, column), index(row, column), ConstraintKind::Structural);
        for (std::uint32_t column = 0; column + 1 < columns_; ++column)
            add_constraint(index(row - 1, column), index(row, column + 1), ConstraintKind::Shear);
        for (std::uint32_t column = 0; column + 1 < columns_; ++column)
            add_constraint(index(row - 1, column + 1), index(row, column), ConstraintKind::Shear);
        for (std::uint32_t column = 0; column + 1 < columns_; ++column) add_square(row - 1, column);
    }

    void add_constraints_across(std::uint32_t row) {
        for (std::uint32_t column = 0; column < columns_; ++column)
            add_constraint(index(row - 2, column), index(row, column), ConstraintKind::Bending);
    }

    void add_square(std::uint32_t row, std::uint32_t column) {
        const std::uint32_t corner = index(row, column);
        const std::uint32_t above = index(row + 1, column);
        cloth_.faces.push_back({corner, corner + 1, above + 1});
        cloth_.faces.push_back({corner, above + 1, above});
    }

    const ClothOptions& options_;
    std::uint32_t columns_, rows_;
    Deformable cloth_;
};

} // namespace

Deformable make_cloth(const ClothOptions& options) {
    require_possible(options);
    return Weaver(options).weave();
}

} // namespace echinus
