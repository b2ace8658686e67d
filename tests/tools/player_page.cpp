#include "tools/player_page.hpp"

#include <zlib.h>

#include <cstring>
#include <stdexcept>

namespace echinus::test {

namespace {

std::string between(const std::string& text, const std::string& begin, const std::string& end) {
    const std::size_t first = text.find(begin);
    const std::size_t last = text.find(end, first);
    if (first == std::string::npos || last == std::string::npos) throw std::runtime_error("no " + begin);
    return text.substr(first + begin.size(), last - first - begin.size());
}

std::uint32_t digit(char c) {
    const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    return static_cast<std::uint32_t>(digits.find(c));
}

std::vector<std::uint8_t> from_base64(const std::string& text) {
    std::vector<std::uint8_t> bytes;
    std::uint32_t bits = 0, bit_count = 0;
    for (const char c : text) {
        if (c == '=') break;
        bits = bits << 6U | digit(c);
        if ((bit_count += 6) < 8) continue;
        bit_count -= 8;
        bytes.push_back(static_cast<std::uint8_t>(bits >> bit_count));
    }
    return bytes;
}

std::vector<std::uint8_t> inflated(const std::vector<std::uint8_t>& compressed, std::size_t size) {
    std::vector<std::uint8_t> bytes(size);
    uLongf length = size;
    if (uncompress(bytes.data(), &length, compressed.data(), compressed.size()) != Z_OK || length != size)
        throw std::runtime_error("the data do not have the size that the description says");
    return bytes;
}

template <typename T>
std::vector<T> take(const std::uint8_t*& bytes, std::size_t count) {
    std::vector<T> values(count);
    std::memcpy(values.data(), bytes, count * sizeof(T));
    bytes += count * sizeof(T);
    return values;
}

/// Differences of either sign from small numbers.
std::int64_t unfolded(std::int64_t code) {
    return code % 2 == 0 ? code / 2 : -(code + 1) / 2;
}

} // namespace

PlayerPage::PlayerPage(const std::string& html) {
    description = nlohmann::json::parse(
        between(html, "<script type=\"application/json\" id=\"description\">", "</script>"));
    const std::size_t vertices = description["model"]["vertices"], faces = description["model"]["faces"];
    const std::size_t cloth = description["cloth_faces"], particles = description["figures"]["particles"];
    const nlohmann::json& frames = description["frames"];
    const std::vector<std::uint8_t> data =
        inflated(from_base64(between(html, "<script type=\"text/plain\" id=\"data\">", "</script>")),
                 12 * (vertices + faces + cloth) + 6 * particles * frames.size());
    const std::uint8_t* next = data.data();
    model_vertices = take<float>(next, 3 * vertices);
    model_faces = take<std::uint32_t>(next, 3 * faces);
    cloth_faces = take<std::uint32_t>(next, 3 * cloth);

    std::vector<std::int64_t> last(3 * particles), before(3 * particles);
    for (const nlohmann::json& frame : frames) {
        std::vector<Point>& points = positions.emplace_back(particles);
        for (std::size_t i = 0; i < 3 * particles; ++i) {
            const std::int64_t now =
                2 * last[i] - before[i] + unfolded(next[i] + 256 * next[3 * particles + i]);
            before[i] = last[i];
            last[i] = now;
            const std::int64_t origin = frame["origin"][i / particles];
            const std::int64_t above = ((now - origin) % 65536 + 65536) % 65536;
            points[i % particles][i / particles] =
                static_cast<double>(origin + above) * description["lattice_step"].get<double>();
        }
        next += 6 * particles;
    }
}

} // namespace echinus::test
