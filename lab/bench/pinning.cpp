#include "pinning.hpp"

#include <sched.h>

namespace {

/// The cores that the process may use, before anything was pinned.
const cpu_set_t& all_cores() {
    static const cpu_set_t cores = [] {
        cpu_set_t set;
        CPU_ZERO(&set);
        sched_getaffinity(0, sizeof(set), &set);
        return set;
    }();
    return cores;
}

} // namespace

void pin_to_one_core() {
    int last = 0;
    for (int core = 0; core < CPU_SETSIZE; ++core)
        if (CPU_ISSET(core, &all_cores())) last = core;
    cpu_set_t one;
    CPU_ZERO(&one);
    CPU_SET(last, &one);
    sched_setaffinity(0, sizeof(one), &one);
}

void unpin() {
    sched_setaffinity(0, sizeof(cpu_set_t), &all_cores());
}
