#include "geometry/precondition.hpp"

#include "files/text.hpp"

#include <echinus/error.hpp>

#include <atomic>
#include <stdexcept>
#include <string>

namespace echinus {

namespace {

std::atomic<PreconditionHandler> handler_of_preconditions{nullptr};

} // namespace

PreconditionHandler set_precondition_handler(PreconditionHandler handler) noexcept {
    return handler_of_preconditions.exchange(handler);
}

bool is_met(bool condition, const char* sentence) {
    if (condition) [[likely]]
        return true;
    const PreconditionHandler handler = handler_of_preconditions.load();
    if (handler == nullptr) throw std::logic_error(sentence);
    handler(sentence);
    return false;
}

bool is_in_range(std::size_t index, std::size_t count, const char* name) {
    return index < count || is_met(false, no_such_text(name, std::to_string(index), count).c_str());
}

} // namespace echinus
