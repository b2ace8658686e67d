#include "handles.hpp"

#include <echinus/map_file.hpp>

namespace echinus::c {

namespace {

AnyMap view_of(const void* bytes, std::size_t byte_count, std::shared_ptr<const void> storage,
               const char* name) {
    const auto* first = static_cast<const std::byte*>(bytes);
    if (reinterpret_cast<std::uintptr_t>(first) % 8 != 0)
        throw WrongArgument("the address of bytes is not a multiple of 8");
    return load_map(values_at(first, byte_count, "bytes"), std::move(storage), &at(name, "name"));
}

} // namespace

} // namespace echinus::c

using namespace echinus;
using namespace echinus::c;

echinus_status echinus_map_save(const echinus_map* map, const char* path) {
    return guarded(__func__, [&] { save(any_map_at(map), &at(path, "path")); });
}

echinus_status echinus_map_serialise(const echinus_map* map, echinus_array** bytes) {
    return make(__func__, bytes, [&] { return array_of(serialise(any_map_at(map))); });
}

echinus_status echinus_map_load(const char* path, echinus_map** map) {
    return make(__func__, map, [&]() -> ColliderMap { return load_map(&at(path, "path")); });
}

echinus_status echinus_map_view(const void* bytes, size_t byte_count, void (*release)(void* context),
                                void* context, const char* name, echinus_map** map) {
    if (map != nullptr) *map = nullptr;
    return guarded(__func__, [&] {
        at(map, "the place for the result");
        const auto storage = std::make_shared<Release>(release, context);
        *map = new echinus_map{view_of(bytes, byte_count, storage, name)};
        storage->arm();
    });
}
