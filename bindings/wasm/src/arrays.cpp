#include "arrays.hpp"

#include "interface.hpp"

namespace echinus::wasm {

ECHINUS_EXPORT(arrays_numbers)
const std::uint32_t* arrays_numbers(const Arrays* arrays, std::uint32_t which) {
    return arrays->numbers[which].data();
}
ECHINUS_EXPORT(arrays_number_count)
std::uint32_t arrays_number_count(const Arrays* arrays, std::uint32_t which) {
    return static_cast<std::uint32_t>(arrays->numbers[which].size());
}
ECHINUS_EXPORT(arrays_floats) const float* arrays_floats(const Arrays* arrays, std::uint32_t which) {
    return arrays->floats[which].data();
}
ECHINUS_EXPORT(arrays_float_count)
std::uint32_t arrays_float_count(const Arrays* arrays, std::uint32_t which) {
    return static_cast<std::uint32_t>(arrays->floats[which].size());
}
ECHINUS_EXPORT(arrays_delete) void arrays_delete(Arrays* arrays) {
    delete arrays;
}

} // namespace echinus::wasm
