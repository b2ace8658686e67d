// Runs a fuzz target without libFuzzer: a fixed number of mutations of the given files, the same on every
// run.
//
//   mutate COUNT SEED_FILE...
//
// An input that makes the target throw is left in mutate_failure.bin.

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes read_seed(const char* path) {
    std::ifstream file(path, std::ios::binary);
    if (!file) {
        std::fprintf(stderr, "mutate: cannot open %s\n", path);
        std::exit(2);
    }
    return {std::istreambuf_iterator<char>(file), {}};
}

class Mutator {
  public:
    /// Up to eight changes in a row, most of them small: a file full of faults is refused at its first byte.
    Bytes mutated(Bytes bytes) {
        const std::size_t change_count = 1 + below(8) * below(2);
        for (std::size_t i = 0; i < change_count && !bytes.empty(); ++i) change(bytes);
        return bytes;
    }

    std::size_t below(std::size_t limit) { return random_() % limit; }

  private:
    void change(Bytes& bytes) {
        switch (below(6)) {
        case 0:
            bytes[below(bytes.size())] ^= static_cast<std::uint8_t>(1U << below(8));
            break;
        case 1:
            bytes[below(bytes.size())] = static_cast<std::uint8_t>(random_());
            break;
        case 2:
            overwrite_word(bytes);
            break;
        case 3:
            copy_within(bytes);
            break;
        case 4:
            bytes.resize(1 + below(bytes.size()));
            break;
        default:
            bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(below(bytes.size())), 1 + below(8), 0);
        }
    }

    /// Counts and references are words; these values overflow sums.
    void overwrite_word(Bytes& bytes) {
        constexpr std::uint32_t kWords[] = {0,          1,          2,          0x7f,
                                            0x8000,     0xffff,     0x7fffffff, 0x80000000,
                                            0xfffffffc, 0xffffffff, 0x7f800000, 0x7fc00000};
        if (bytes.size() < 4) return;
        const std::uint32_t word = kWords[below(std::size(kWords))];
        const std::size_t position = below(bytes.size() / 4) * 4;
        for (std::size_t i = 0; i < 4; ++i) bytes[position + i] = static_cast<std::uint8_t>(word >> 8 * i);
    }

    void copy_within(Bytes& bytes) {
        const std::size_t length = 1 + below(std::min<std::size_t>(bytes.size(), 16));
        const std::size_t from = below(bytes.size() - length + 1);
        const std::size_t to = below(bytes.size() - length + 1);
        const Bytes piece(bytes.begin() + static_cast<std::ptrdiff_t>(from),
                          bytes.begin() + static_cast<std::ptrdiff_t>(from + length));
        std::copy(piece.begin(), piece.end(), bytes.begin() + static_cast<std::ptrdiff_t>(to));
    }

    std::mt19937 random_{1};
};

void run(const Bytes& bytes) {
    try {
        LLVMFuzzerTestOneInput(bytes.data(), bytes.size());
    } catch (const std::exception& error) {
        std::ofstream("mutate_failure.bin", std::ios::binary)
            .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
        std::fprintf(stderr, "mutate: %s; the input is in mutate_failure.bin\n", error.what());
        std::exit(1);
    }
}

} // namespace

int main(int argc, char** argv) {
    if (argc < 3) {
        std::fputs("usage: mutate COUNT SEED_FILE...\n", stderr);
        return 2;
    }
    std::vector<Bytes> seeds;
    for (int i = 2; i < argc; ++i) seeds.push_back(read_seed(argv[i]));
    for (const Bytes& seed : seeds) run(seed);
    Mutator mutator;
    for (long count = std::strtol(argv[1], nullptr, 10); count > 0; --count) {
        run(mutator.mutated(seeds[mutator.below(seeds.size())]));
    }
    return 0;
}
