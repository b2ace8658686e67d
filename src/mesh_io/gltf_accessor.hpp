#pragma once

#include "mesh_io/gltf_file.hpp"

#include <echinus/geometry.hpp>

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

namespace echinus {

/// The numbers of an accessor (glTF 2.0, sections 3.6.2 and 5.1), with any stride, sparse or not. They are
/// read when they are asked for.
class GltfAccessor {
  public:
    /// @param user  the value that names the accessor, in sentences
    /// @throws Error Damaged when a buffer ends before the accessor does, InvalidMesh for what makes no sense
    GltfAccessor(GltfFile& file, const GltfValue& user);

    std::size_t count() const { return count_; }
    std::size_t width() const { return width_; } ///< numbers of an element
    bool has_own_bytes() const { return !dense_.bytes.empty(); }

    /// Integers that stand for fractions become them (section 3.6.2.2).
    /// @pre element < count(), component < width()
    double number(std::size_t element, std::size_t component) const;
    Vec3d vector(std::size_t element) const {
        return {number(element, 0), number(element, 1), number(element, 2)};
    }
    /// @pre the accessor was required to have whole numbers
    std::uint32_t natural_number(std::size_t element, std::size_t component = 0) const;

    /// @throws Error InvalidMesh
    void require_width(std::size_t width) const;
    void require_count(std::size_t count) const;
    void require_natural_numbers() const;

  private:
    struct Elements {
        std::string_view bytes; ///< from the first element on; empty where all numbers are 0
        std::size_t stride = 0;
    };

    Elements elements_of(const GltfValue& owner, std::size_t count, std::size_t size) const;
    void read_sparse(const GltfValue& sparse);
    const char* find(std::size_t element, std::size_t component) const;

    GltfFile& file_;
    GltfValue user_;
    std::size_t count_, width_;
    std::size_t component_type_;
    std::size_t component_size_;
    bool is_normalized_;
    Elements dense_, replaced_;
    std::vector<std::uint32_t> replaced_elements_; ///< ascending
};

} // namespace echinus
