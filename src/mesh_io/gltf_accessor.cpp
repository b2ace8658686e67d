#include "mesh_io/gltf_accessor.hpp"

#include "geometry/whole_numbers.hpp"

#include <algorithm>
#include <cstring>
#include <limits>
#include <string>
#include <utility>

namespace echinus {

namespace {

// OpenGL's names of the types.
constexpr std::size_t kByte = 5120, kUnsignedByte = 5121, kShort = 5122, kUnsignedShort = 5123,
                      kUnsignedInt = 5125, kFloat = 5126;

std::size_t size_of_component(const GltfValue& type) {
    switch (type.natural_number()) {
    case kByte:
    case kUnsignedByte:
        return 1;
    case kShort:
    case kUnsignedShort:
        return 2;
    case kUnsignedInt:
    case kFloat:
        return 4;
    default:
        type.fail("is no type of numbers of glTF");
    }
}

std::size_t width_of(const GltfValue& type) {
    constexpr std::pair<std::string_view, std::size_t> kWidths[] = {
        {"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT2", 4}, {"MAT3", 9}, {"MAT4", 16}};
    const std::string name = type.string();
    for (const auto& [known, width] : kWidths)
        if (name == known) return width;
    type.fail("is no type of glTF");
}

/// glTF is little-endian.
template <typename Integer>
Integer integer_at(const char* bytes) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < sizeof(Integer); ++i)
        value |= std::uint32_t{static_cast<unsigned char>(bytes[i])} << 8 * i;
    return static_cast<Integer>(value);
}

/// The largest value of the type stands for 1, and so does the smallest for -1.
template <typename Integer>
double fraction(Integer value) {
    return std::max(-1.0, static_cast<double>(value) / std::numeric_limits<Integer>::max());
}

template <typename Integer>
double number_at(const char* bytes, bool is_normalized) {
    const auto value = integer_at<Integer>(bytes);
    return is_normalized ? fraction(value) : static_cast<double>(value);
}

} // namespace

GltfAccessor::GltfAccessor(GltfFile& file, const GltfValue& user)
    : file_(file), user_(user), count_(0), width_(0), component_type_(0), component_size_(0),
      is_normalized_(false) {
    const GltfValue& accessor = file.element("accessors", user);
    const GltfValue component_type = accessor.member("componentType");
    component_size_ = size_of_component(component_type);
    component_type_ = component_type.natural_number();
    width_ = width_of(accessor.member("type"));
    count_ = accessor.member("count").natural_number();
    is_normalized_ = accessor.member("normalized").boolean();
    if (count_ > std::numeric_limits<std::uint32_t>::max()) // by which they are numbered
        accessor.member("count").fail("is larger than 2^32 - 1");
    if (accessor.member("bufferView").exists())
        dense_ = elements_of(accessor, count_, width_ * component_size_);
    if (const GltfValue sparse = accessor.member("sparse"); sparse.exists()) read_sparse(sparse);
}

/// @param owner  has a bufferView and perhaps a byteOffset
/// @param size   bytes of an element
GltfAccessor::Elements GltfAccessor::elements_of(const GltfValue& owner, std::size_t count,
                                                 std::size_t size) const {
    const GltfValue& view = file_.element("bufferViews", owner.member("bufferView"));
    const std::string_view buffer = file_.buffer(view.member("buffer"));
    const std::size_t begin = view.member("byteOffset").optional_number().value_or(0);
    const std::size_t length = view.member("byteLength").natural_number();
    if (begin > buffer.size() || length > buffer.size() - begin)
        view.fail("ends at byte " + std::to_string(begin + length) + " of a buffer of " +
                      std::to_string(buffer.size()) + " bytes",
                  ErrorCode::Damaged);
    const std::size_t stride = view.member("byteStride").optional_number().value_or(size);
    if (stride < size) view.member("byteStride").fail("is shorter than an element of " + owner.path());
    const std::size_t offset = owner.member("byteOffset").optional_number().value_or(0);
    // In this form nothing overflows: the last element ends at offset + (count - 1) stride + size.
    const bool fits = count == 0 || (offset <= length && size <= length - offset &&
                                     (count - 1) <= (length - offset - size) / stride);
    if (!fits)
        owner.fail("has " + std::to_string(count) + " elements of " + std::to_string(size) +
                       " bytes, one each " + std::to_string(stride) + " from byte " + std::to_string(offset) +
                       " on: more than the " + std::to_string(length) + " bytes of " + view.path(),
                   ErrorCode::Damaged);
    return {buffer.substr(begin, length).substr(std::min(offset, length)), stride};
}

void GltfAccessor::read_sparse(const GltfValue& sparse) {
    const std::size_t count = sparse.member("count").natural_number();
    const GltfValue indices = sparse.member("indices");
    const GltfValue type = indices.member("componentType");
    const std::size_t size = size_of_component(type);
    const Elements elements = elements_of(indices, count, size);
    replaced_ = elements_of(sparse.member("values"), count, width_ * component_size_);
    file_.spend(count);
    for (std::size_t i = 0; i < count; ++i) {
        const char* bytes = elements.bytes.data() + i * elements.stride;
        const std::uint32_t element = size == 1   ? integer_at<std::uint8_t>(bytes)
                                      : size == 2 ? integer_at<std::uint16_t>(bytes)
                                                  : integer_at<std::uint32_t>(bytes);
        const bool ascends = replaced_elements_.empty() || element > replaced_elements_.back();
        if (element >= count_ || !ascends)
            indices.fail("has the element " + std::to_string(element) + " at " + std::to_string(i) +
                         "; they must ascend, and be less than " + std::to_string(count_));
        replaced_elements_.push_back(element);
    }
}

const char* GltfAccessor::find(std::size_t element, std::size_t component) const {
    const Elements* elements = &dense_;
    if (!replaced_elements_.empty()) {
        const auto found = std::lower_bound(replaced_elements_.begin(), replaced_elements_.end(), element);
        if (found != replaced_elements_.end() && *found == element) {
            elements = &replaced_;
            element = static_cast<std::size_t>(found - replaced_elements_.begin());
        }
    }
    if (elements->bytes.empty()) return nullptr;
    return elements->bytes.data() + element * elements->stride + component * component_size_;
}

double GltfAccessor::number(std::size_t element, std::size_t component) const {
    const char* bytes = find(element, component);
    if (bytes == nullptr) return 0;
    switch (component_type_) {
    case kByte:
        return number_at<std::int8_t>(bytes, is_normalized_);
    case kUnsignedByte:
        return number_at<std::uint8_t>(bytes, is_normalized_);
    case kShort:
        return number_at<std::int16_t>(bytes, is_normalized_);
    case kUnsignedShort:
        return number_at<std::uint16_t>(bytes, is_normalized_);
    case kUnsignedInt:
        return number_at<std::uint32_t>(bytes, is_normalized_);
    default:
        return double{echinus::bit_cast<float>(integer_at<std::uint32_t>(bytes))};
    }
}

std::uint32_t GltfAccessor::natural_number(std::size_t element, std::size_t component) const {
    const char* bytes = find(element, component);
    if (bytes == nullptr) return 0;
    return component_size_ == 1   ? integer_at<std::uint8_t>(bytes)
           : component_size_ == 2 ? integer_at<std::uint16_t>(bytes)
                                  : integer_at<std::uint32_t>(bytes);
}

void GltfAccessor::require_width(std::size_t width) const {
    if (width_ != width)
        user_.fail("has elements of " + std::to_string(width_) + " numbers in place of " +
                   std::to_string(width));
}

void GltfAccessor::require_count(std::size_t count) const {
    if (count_ != count)
        user_.fail("has " + std::to_string(count_) + " entries, but needs " + std::to_string(count) +
                   "; export the file again");
}

void GltfAccessor::require_natural_numbers() const {
    if (component_type_ != kUnsignedByte && component_type_ != kUnsignedShort &&
        component_type_ != kUnsignedInt)
        user_.fail("has numbers of a type that cannot count");
}

} // namespace echinus
