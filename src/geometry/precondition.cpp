#include "geometry/precondition.hpp"

#include <echinus/error.hpp>

#include <atomic>
#include <stdexcept>

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

} // namespace echinus
