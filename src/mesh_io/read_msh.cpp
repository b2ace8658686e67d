#include "mesh_io/readers.hpp"

#include <array>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>

// The format: "MSH file format" in the manual of Gmsh, versions 2.2 and 4.1
// (https://gmsh.info/doc/texinfo/gmsh.html#MSH-file-format). Reads the nodes and the elements that are
// tetrahedra with four corners; skips points, lines and faces, which only name parts of the boundary.

namespace echinus {

namespace {

constexpr std::int64_t kMshTetrahedron = 4;

/// The number of nodes of an element type with at most two dimensions; none for other types.
std::optional<int> flat_node_count(std::int64_t type) {
    constexpr std::array<std::array<int, 2>, 17> kFlat{{{1, 2},
                                                        {2, 3},
                                                        {3, 4},
                                                        {8, 3},
                                                        {9, 6},
                                                        {10, 9},
                                                        {15, 1},
                                                        {16, 8},
                                                        {20, 9},
                                                        {21, 10},
                                                        {22, 12},
                                                        {23, 15},
                                                        {24, 15},
                                                        {25, 21},
                                                        {26, 4},
                                                        {27, 5},
                                                        {28, 6}}};
    for (const auto& [number, node_count] : kFlat)
        if (number == type) return node_count;
    return {};
}

/// Reads the sections $Nodes and $Elements.
class MshReader {
  public:
    MshReader(NumberSource& numbers, bool is_binary, bool is_version_4)
        : numbers_(numbers), is_binary_(is_binary), is_version_4_(is_version_4) {}

    TetrahedraInFile read() {
        bool has_nodes = false, has_elements = false;
        while (!has_nodes || !has_elements) {
            const std::string section(
                numbers_.require_line(has_nodes ? "the section $Elements" : "the section $Nodes")[0]);
            if (section == "$Nodes" && !has_nodes) {
                has_nodes = true;
                is_version_4_ ? read_nodes_4() : read_nodes_2();
                require_end("$EndNodes");
            } else if (section == "$Elements" && has_nodes) {
                has_elements = true;
                is_version_4_ ? read_elements_4() : read_elements_2();
                require_end("$EndElements");
            } else if (section.starts_with("$") && section != "$Elements" && section != "$Nodes") {
                numbers_.skip_to_line("$End" + section.substr(1));
            } else {
                numbers_.fail(ErrorCode::Damaged,
                              "$Nodes and then $Elements were expected, not " + in_quotes(section));
            }
        }
        return std::move(mesh_);
    }

  private:
    void require_end(const std::string& end) {
        if (numbers_.require_line(end)[0] != end)
            numbers_.fail(ErrorCode::Damaged, end + " was expected: the counts before it are wrong");
    }

    std::int64_t int32(const char* what) { return numbers_.integer(NumberType::Int32, what); }
    std::int64_t int64(const char* what) { return numbers_.integer(NumberType::Int64, what); }

    // ---- Version 2.2

    /// This number is text even in a binary file.
    std::size_t count_line(const char* what) {
        const std::string_view word = numbers_.require_line(what)[0];
        std::int64_t count = 0;
        if (!parse_integer(word, count) || count < 0)
            numbers_.fail(ErrorCode::Damaged, std::string(what) + " was expected, not " + in_quotes(word));
        return static_cast<std::size_t>(count);
    }

    void read_nodes_2() {
        for (std::size_t left = count_line("the number of nodes"); left > 0; --left) {
            add_node(int32("a node's number"));
            mesh_.vertices.back() = next_position();
        }
    }

    void read_elements_2() {
        std::size_t left = count_line("the number of elements");
        while (left > 0) {
            std::size_t in_block = 1;
            std::int64_t type = 0, tag_count = 0;
            if (is_binary_) {
                type = int32("an element's type");
                in_block = numbers_.count(NumberType::Int32, "the number of elements");
                tag_count = int32("the number of tags");
                if (in_block == 0 || in_block > left)
                    numbers_.fail(ErrorCode::Damaged, "there are more elements than their number says");
            } else {
                int32("an element's number");
                type = int32("an element's type");
                tag_count = int32("the number of tags");
            }
            if (tag_count < 0) numbers_.fail(ErrorCode::Damaged, "the number of tags is negative");
            for (std::size_t i = 0; i < in_block; ++i) {
                if (is_binary_) int32("an element's number");
                for (std::int64_t tag = 0; tag < tag_count; ++tag) int32("a tag");
                read_element(type, NumberType::Int32);
            }
            left -= in_block;
        }
    }

    // ---- Version 4.1

    void read_nodes_4() {
        const std::size_t block_count = numbers_.count(NumberType::Int64, "the number of blocks");
        const std::size_t node_count = numbers_.count(NumberType::Int64, "the number of nodes");
        int64("the smallest number of a node");
        int64("the largest number of a node");
        for (std::size_t block = 0; block < block_count; ++block) {
            const std::int64_t dimension = int32("a dimension");
            int32("an entity's number");
            const bool is_parametric = int32("0 or 1") != 0;
            const std::size_t in_block = numbers_.count(NumberType::Int64, "the number of nodes");
            const std::size_t first = mesh_.vertices.size();
            for (std::size_t i = 0; i < in_block; ++i) add_node(int64("a node's number"));
            for (std::size_t i = 0; i < in_block; ++i) {
                mesh_.vertices[first + i] = next_position();
                for (std::int64_t k = 0; is_parametric && k < dimension && k < 3; ++k)
                    numbers_.coordinate(NumberType::Float64);
            }
        }
        if (mesh_.vertices.size() != node_count)
            numbers_.fail(ErrorCode::Damaged, "there are " + std::to_string(mesh_.vertices.size()) +
                                                  " nodes, not " + std::to_string(node_count) +
                                                  " as the section declares");
    }

    void read_elements_4() {
        const std::size_t block_count = numbers_.count(NumberType::Int64, "the number of blocks");
        const std::size_t element_count = numbers_.count(NumberType::Int64, "the number of elements");
        int64("the smallest number of an element");
        int64("the largest number of an element");
        std::size_t read_count = 0;
        for (std::size_t block = 0; block < block_count; ++block) {
            int32("a dimension");
            int32("an entity's number");
            const std::int64_t type = int32("an element's type");
            const std::size_t in_block = numbers_.count(NumberType::Int64, "the number of elements");
            for (std::size_t i = 0; i < in_block; ++i) {
                int64("an element's number");
                read_element(type, NumberType::Int64);
            }
            read_count += in_block;
        }
        if (read_count != element_count)
            numbers_.fail(ErrorCode::Damaged, "there are " + std::to_string(read_count) + " elements, not " +
                                                  std::to_string(element_count) + " as the section declares");
    }

    // ---- Both versions

    void add_node(std::int64_t number) {
        const auto index = static_cast<std::uint32_t>(mesh_.vertices.size());
        if (!index_of_.emplace(number, index).second)
            numbers_.fail(ErrorCode::Damaged, "there are two nodes " + std::to_string(number));
        mesh_.vertices.emplace_back();
    }

    Vec3d next_position() { return numbers_.position(NumberType::Float64); }

    void read_element(std::int64_t type, NumberType number_type) {
        if (type == kMshTetrahedron) {
            Tetrahedron& corners = mesh_.tetrahedra.emplace_back();
            for (std::uint32_t& corner : corners) corner = index_of(numbers_.integer(number_type, "a node"));
            return;
        }
        const std::optional<int> node_count = flat_node_count(type);
        if (!node_count)
            numbers_.fail(
                ErrorCode::WrongFormat,
                "an element of type " + std::to_string(type) +
                    " is not a tetrahedron with four corners; save the body as first-order tetrahedra");
        for (int i = 0; i < *node_count; ++i) numbers_.integer(number_type, "a node");
    }

    std::uint32_t index_of(std::int64_t number) const {
        const auto found = index_of_.find(number);
        if (found == index_of_.end())
            numbers_.fail(ErrorCode::InvalidMesh,
                          "an element refers to node " + std::to_string(number) + ", which does not exist");
        return found->second;
    }

    NumberSource& numbers_;
    bool is_binary_, is_version_4_;
    TetrahedraInFile mesh_;
    std::unordered_map<std::int64_t, std::uint32_t> index_of_; ///< the index of a node, by its number
};

} // namespace

TetrahedraInFile read_msh(const MeshSource& source) {
    LineScanner scanner(source);
    scanner.require_line("$MeshFormat");
    if (const std::string_view word = scanner.next_word(); word != "$MeshFormat")
        scanner.fail_expecting("$MeshFormat", word, ErrorCode::WrongFormat);
    scanner.require_line("the version of the format");
    const std::string_view version = scanner.next_word();
    const bool is_version_4 = version == "4.1";
    if (!is_version_4 && version != "2.2" && version != "2.1" && version != "2")
        scanner.fail(ErrorCode::WrongFormat,
                     "version " + in_quotes(version) + " is not read; save the file as version 4.1 or 2.2");
    const bool is_binary = scanner.next_integer("0 for text or 1 for binary") != 0;
    if (scanner.next_integer("the size of a number") != 8)
        scanner.fail(ErrorCode::WrongFormat, "numbers of other sizes than 8 bytes are not read");
    if (is_binary) {
        const bool is_little = source.bytes.substr(scanner.offset(), 1) == "\1";
        BinaryNumbers numbers(source, scanner.offset(),
                              is_little ? ByteOrder::LittleEndian : ByteOrder::BigEndian);
        if (numbers.integer(NumberType::Int32, "one") != 1)
            numbers.fail(ErrorCode::Damaged, "the number 1 was expected, which tells the order of bytes");
        numbers.skip_to_line("$EndMeshFormat");
        return MshReader(numbers, true, is_version_4).read();
    }
    TextNumbers numbers(source, scanner);
    numbers.skip_to_line("$EndMeshFormat");
    return MshReader(numbers, false, is_version_4).read();
}

} // namespace echinus
