#include "mesh_io/scenes/gltf_file.hpp"

#include "files/read_file.hpp"
#include "files/text.hpp"
#include "geometry/whole_numbers.hpp"
#include "mesh_io/mesh_source.hpp"
#include "mesh_io/readers.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <set>
#include <string>
#include <utility>

namespace echinus {

using nlohmann::json;

namespace {

namespace fs = std::filesystem;

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
constexpr std::size_t kChunkHeadSize = 8; // length and type

/// Refuses two kinds of text that the parser would accept: two values with one key, of which it keeps the
/// last (section 2.7 of the specification forbids them), and brackets nested without limit. This is a
/// separate pass, because the parser's callback takes time quadratic in the number of elements of an array.
class StrictPass : public nlohmann::json_sax<json> {
  public:
    explicit StrictPass(const MeshSource& source) : source_(source) {}

    bool start_object(std::size_t) override {
        open();
        keys_.emplace_back();
        return true;
    }
    bool key(string_t& name) override {
        if (!keys_.back().insert(name).second)
            source_.fail(ErrorCode::Damaged, "the key " + in_quotes(name) + " is given twice in one object");
        return true;
    }
    bool end_object() override {
        keys_.pop_back();
        --depth_;
        return true;
    }
    bool start_array(std::size_t) override {
        open();
        return true;
    }
    bool end_array() override {
        --depth_;
        return true;
    }
    bool null() override { return true; }
    bool boolean(bool) override { return true; }
    bool number_integer(number_integer_t) override { return true; }
    bool number_unsigned(number_unsigned_t) override { return true; }
    bool number_float(number_float_t, const string_t&) override { return true; }
    bool string(string_t&) override { return true; }
    bool binary(binary_t&) override { return true; }
    /// The parser will find the error again and report more about it.
    bool parse_error(std::size_t, const std::string&, const json::exception&) override { return false; }

  private:
    void open() {
        constexpr int kMostBrackets = 256;
        if (++depth_ > kMostBrackets)
            source_.fail(ErrorCode::Damaged, "the JSON has too many nested brackets, of which at most " +
                                                 std::to_string(kMostBrackets) + " are read");
    }

    const MeshSource& source_;
    int depth_ = 0;
    std::vector<std::set<std::string>> keys_; // the keys of the open objects
};

/// The chunks of a GLB file (section 4.4). Chunks that are not padded to four bytes are accepted.
struct GlbChunks {
    std::string_view text;
    std::optional<std::string_view> binary;
};

std::optional<std::string_view> binary_chunk(const MeshSource& source, std::size_t begin) {
    ByteReader head(source, begin, ByteOrder::LittleEndian);
    if (head.bytes_left() < kChunkHeadSize) return std::nullopt;
    const std::size_t length = head.next<std::uint32_t>();
    if (source.bytes.substr(head.offset(), 4) != std::string_view("BIN\0", 4)) return std::nullopt;
    head.skip(4);
    const std::size_t content = head.offset();
    head.skip(length);
    return source.bytes.substr(content, length);
}

GlbChunks chunks_of(const MeshSource& source) {
    constexpr std::size_t kMagicSize = 4;
    ByteReader head(source, kMagicSize, ByteOrder::LittleEndian);
    const auto version = head.next<std::uint32_t>();
    if (version != 2)
        source.fail(ErrorCode::WrongFormat, "the file is of version " + std::to_string(version) +
                                                " of GLB, but only version 2 is read; export it as glTF 2.0");
    const std::size_t length = head.next<std::uint32_t>();
    if (length != source.bytes.size())
        source.fail(ErrorCode::Damaged, "the file says that it has " + std::to_string(length) +
                                            " bytes, but it has " + std::to_string(source.bytes.size()));
    const std::size_t text_length = head.next<std::uint32_t>();
    if (source.bytes.substr(head.offset(), 4) != "JSON")
        source.fail(ErrorCode::Damaged, "the first chunk of the file is not JSON");
    head.skip(4);
    const std::size_t begin = head.offset();
    head.skip(text_length);
    GlbChunks chunks{source.bytes.substr(begin, text_length), binary_chunk(source, head.offset())};
    if (!chunks.binary) chunks.binary = binary_chunk(source, (head.offset() + 3) / 4 * 4);
    return chunks;
}

std::optional<unsigned> hexadecimal_digit(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    return std::nullopt;
}

/// Replaces %20 and similar codes by the bytes that they stand for (RFC 3986, section 2.1).
std::string percent_decoded(std::string_view uri) {
    std::string text;
    for (std::size_t i = 0; i < uri.size(); ++i) {
        const auto high = i + 2 < uri.size() ? hexadecimal_digit(uri[i + 1]) : std::nullopt;
        const auto low = high ? hexadecimal_digit(uri[i + 2]) : std::nullopt;
        const bool is_code = uri[i] == '%' && low;
        text += is_code ? static_cast<char>(*high << 4U | *low) : uri[i];
        if (is_code) i += 2;
    }
    return text;
}

/// White space and the padding at the end are skipped (RFC 4648).
std::string base64_decoded(std::string_view text, const GltfValue& buffer) {
    constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::array<int, 256> value_of{};
    value_of.fill(-1);
    for (std::size_t i = 0; i < kDigits.size(); ++i)
        value_of[static_cast<unsigned char>(kDigits[i])] = static_cast<int>(i);
    std::string bytes;
    std::uint32_t bits = 0;
    unsigned bit_count = 0;
    for (const char c : text.substr(0, text.find('='))) {
        const int value = value_of[static_cast<unsigned char>(c)];
        if (value < 0 && std::string_view(" \t\r\n").find(c) != std::string_view::npos) continue;
        if (value < 0)
            buffer.fail("has the character " + in_quotes({&c, 1}) + ", which is not base64",
                        ErrorCode::Damaged);
        bits = bits << 6U | static_cast<std::uint32_t>(value);
        bit_count += 6;
        if (bit_count < 8) continue;
        bit_count -= 8;
        bytes.push_back(static_cast<char>(bits >> bit_count & 0xFFU));
    }
    return bytes;
}

std::string data_of(std::string_view uri, const GltfValue& buffer) {
    const std::size_t comma = uri.find(',');
    if (comma == std::string_view::npos) buffer.fail("has data without a comma", ErrorCode::Damaged);
    const std::string_view content = uri.substr(comma + 1);
    return uri.substr(0, comma).ends_with(";base64") ? base64_decoded(content, buffer)
                                                     : percent_decoded(content);
}

/// A name for use in a sentence.
std::string shown(std::string_view name) {
    constexpr std::size_t kMostLetters = 100;
    return printable(name.substr(0, kMostLetters));
}

/// Extensions that do not change the meaning of positions and faces, or that are supported.
bool is_readable_extension(std::string_view name) {
    constexpr std::string_view kRead[] = {"KHR_mesh_quantization", "EXT_mesh_gpu_instancing"};
    constexpr std::string_view kOfAppearance[] = {"KHR_materials_", "KHR_texture_", "EXT_texture_",
                                                  "MSFT_texture_",  "KHR_lights_",  "EXT_lights_",
                                                  "KHR_technique",  "KHR_xmp"};
    return std::find(std::begin(kRead), std::end(kRead), name) != std::end(kRead) ||
           std::any_of(std::begin(kOfAppearance), std::end(kOfAppearance),
                       [&](std::string_view beginning) { return name.starts_with(beginning); });
}

} // namespace

void require_beginning_of_gltf(const MeshSource& beginning) {
    std::string_view text = beginning.bytes;
    if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
    const std::size_t first = text.find_first_not_of(" \t\r\n");
    // If there is only white space, the brace may still follow.
    if (first != std::string_view::npos && text[first] != '{')
        beginning.fail(ErrorCode::WrongFormat, "the brace with which a glTF file begins was not found");
}

void require_beginning_of_glb(const MeshSource& beginning) {
    if (!beginning.bytes.starts_with("glTF"))
        beginning.fail(ErrorCode::WrongFormat, "the word glTF with which a GLB file begins was not found");
}

// ---- Values ----

void GltfValue::fail(const std::string& what, ErrorCode code) const {
    source_->fail(code, (path_.empty() ? "the JSON" : printable(path_)) + " " + what);
}

GltfValue GltfValue::member(const char* key) const {
    const std::string path = path_.empty() ? key : path_ + "." + key;
    if (!exists()) return {*source_, nullptr, path};
    if (!value_->is_object()) fail("is not an object in braces");
    const auto found = value_->find(key);
    return {*source_, found == value_->end() ? nullptr : &*found, path};
}

std::vector<GltfValue> GltfValue::elements() const {
    std::vector<GltfValue> values;
    if (!exists()) return values;
    if (!value_->is_array()) fail("is not an array");
    for (std::size_t i = 0; i < value_->size(); ++i)
        values.emplace_back(*source_, &(*value_)[i], path_ + "[" + std::to_string(i) + "]");
    return values;
}

double GltfValue::number() const {
    if (!exists()) fail("is missing");
    if (!value_->is_number()) fail("is not a number");
    return value_->get<double>();
}

std::size_t GltfValue::natural_number() const {
    const double value = number();
    if (!(value >= 0 && value <= 0x1p53) || value != std::floor(value))
        fail("is not a whole number from 0 to 2^53");
    return static_cast<std::size_t>(value);
}

std::optional<std::size_t> GltfValue::optional_number() const {
    return exists() ? std::optional(natural_number()) : std::nullopt;
}

std::vector<double> GltfValue::numbers() const {
    std::vector<double> values;
    for (const GltfValue& element : elements()) values.push_back(element.number());
    return values;
}

std::optional<std::vector<double>> GltfValue::numbers(std::size_t count) const {
    if (!exists()) return std::nullopt;
    std::vector<double> values = numbers();
    if (values.size() != count)
        fail("has " + std::to_string(values.size()) + " numbers in place of " + std::to_string(count));
    return values;
}

std::string GltfValue::string() const {
    if (!exists()) return "";
    if (!value_->is_string()) fail("is not a string");
    return value_->get<std::string>();
}

bool GltfValue::boolean() const {
    if (!exists()) return false;
    if (!value_->is_boolean()) fail("is neither true nor false");
    return value_->get<bool>();
}

// ---- The file ----

GltfFile::GltfFile(const MeshSource& source) : source_(source), budget_(source) {
    if (lower_case_ending(source.name) == ".glb") {
        require_beginning_of_glb(source);
        const GlbChunks chunks = chunks_of(source);
        binary_ = chunks.binary;
        parse(chunks.text);
    } else {
        require_beginning_of_gltf(source);
        parse(source.bytes);
    }
    require_readable();
}

void GltfFile::parse(std::string_view text) {
    try {
        StrictPass pass(source_);
        json::sax_parse(text, &pass);
        document_ = json::parse(text);
    } catch (const json::parse_error& error) {
        source_.fail(ErrorCode::Damaged, "the JSON is malformed at byte " + std::to_string(error.byte) +
                                             "; export the file again, as UTF-8");
    } catch (const json::exception&) {
        source_.fail(ErrorCode::Damaged, "the JSON has a number that is too large to be read");
    }
}

void GltfFile::require_readable() const {
    const GltfValue version = root().member("asset").member("version");
    if (!version.string().starts_with("2."))
        source_.fail(
            ErrorCode::WrongFormat,
            version.exists()
                ? "the file is of version " + in_quotes(version.string()) +
                      " of glTF, but only version 2 is read; export it as glTF 2.0"
                : std::string("the file does not say of which version of glTF it is (asset.version)"));
    for (const GltfValue& extension : root().member("extensionsRequired").elements())
        if (!is_readable_extension(extension.string()))
            source_.fail(ErrorCode::WrongFormat, "the file requires the extension " +
                                                     shown(extension.string()) +
                                                     ", which is not read; export it without");
}

const GltfValue& GltfFile::element(const char* key, const GltfValue& user) {
    auto found = arrays_.find(key);
    if (found == arrays_.end()) found = arrays_.emplace(key, root().member(key).elements()).first;
    const std::size_t index = user.natural_number();
    if (index >= found->second.size())
        user.fail("is " + std::to_string(index) + ", but there are " + std::to_string(found->second.size()) +
                  " " + key + ", numbered from 0");
    return found->second[index];
}

std::string_view GltfFile::read_beside(const GltfValue& buffer, const std::string& uri) {
    if (uri.find("://") != std::string::npos || utf8_path(percent_decoded(uri)).has_root_path())
        buffer.fail("lies at " + shown(uri) + "; only files named by their path from this one are read",
                    ErrorCode::Unreadable);
    const auto [entry, is_new] = files_.try_emplace(uri);
    std::vector<std::byte>& bytes = entry->second;
    if (is_new) {
        const fs::path folder = utf8_path(source_.name).parent_path();
        std::error_code ignored;
        fs::path path = folder / utf8_path(percent_decoded(uri));
        // The name itself may contain a percent sign.
        if (!fs::exists(path, ignored)) path = folder / utf8_path(uri);
        // A pipe or a device might be endless.
        if (!fs::is_regular_file(path, ignored))
            buffer.fail("is in the file " + shown(uri) + ", which is not there or is not a regular file",
                        ErrorCode::Unreadable);
        try {
            bytes = read_file(path);
        } catch (const Error& error) {
            buffer.fail("cannot be read: " + std::string(error.what()), error.code());
        }
        budget_.add_bytes(bytes.size());
    }
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

std::string_view GltfFile::open_buffer(const GltfValue& buffer, std::size_t number) {
    const std::string uri = buffer.member("uri").string();
    if (uri.starts_with("data:")) return decoded_[number] = data_of(uri, buffer);
    if (!uri.empty()) return read_beside(buffer, uri);
    if (number != 0 || !binary_)
        buffer.fail("has no bytes: neither a uri nor the binary part of a GLB file", ErrorCode::Damaged);
    return *binary_;
}

std::string_view GltfFile::buffer(const GltfValue& user) {
    const GltfValue& value = element("buffers", user);
    const std::size_t number = user.natural_number();
    const auto [entry, is_new] = buffers_.try_emplace(number);
    if (is_new) {
        const std::string_view bytes = open_buffer(value, number);
        const std::size_t length = value.member("byteLength").natural_number();
        if (bytes.size() < length)
            value.fail("has " + std::to_string(bytes.size()) + " bytes, but declares " +
                           std::to_string(length),
                       ErrorCode::Damaged);
        entry->second = bytes.substr(0, length);
    }
    return entry->second;
}

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
        type.fail("is not a component type of glTF");
    }
}

std::size_t width_of(const GltfValue& type) {
    constexpr std::pair<std::string_view, std::size_t> kWidths[] = {
        {"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT2", 4}, {"MAT3", 9}, {"MAT4", 16}};
    const std::string name = type.string();
    for (const auto& [known, width] : kWidths)
        if (name == known) return width;
    type.fail("is not an accessor type of glTF");
}

/// glTF is little-endian.
template <typename Integer>
Integer integer_at(const char* bytes) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < sizeof(Integer); ++i)
        value |= std::uint32_t{static_cast<unsigned char>(bytes[i])} << 8 * i;
    return static_cast<Integer>(value);
}

/// The largest value of the type stands for 1, and the smallest for -1.
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
    if (count_ > std::numeric_limits<std::uint32_t>::max()) // elements are numbered by 32 bits
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
    // This form does not overflow: the last element ends at offset + (count - 1) stride + size.
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
        user_.fail("has numbers of a type that is not allowed for indices");
}

} // namespace echinus
