#pragma once

#include <echinus/error.hpp>
#include <echinus/simulation.hpp>

#include <pybind11/pybind11.h>

#include <mutex>
#include <utility>

namespace echinus::python {

namespace py = pybind11;

/// A simulation that several threads may call: one at a time computes, without Python's lock.
class SharedSimulation {
  public:
    explicit SharedSimulation(Simulation simulation) : simulation_(std::move(simulation)) {}

    /// Calls work(simulation) while no other thread does.
    template <typename Work>
    auto alone(const Work& work) {
        // Python's lock is released first: a thread that held it while waiting for the mutex would block the
        // thread that computes.
        const py::gil_scoped_release released;
        const std::lock_guard guard(mutex_);
        return work(simulation_);
    }
    /// The same for work that changes the simulation, which is not possible after it has diverged.
    template <typename Work>
    void change(const Work& work) {
        alone([&](Simulation& simulation) {
            if (diverged_)
                throw Error(ErrorCode::Diverged, "the simulation has diverged; it can only be read");
            try {
                work(simulation);
            } catch (const Error& error) {
                diverged_ = error.code() == ErrorCode::Diverged;
                throw;
            }
        });
    }
    /// For data that no step changes: options, faces, and the addresses of the positions.
    const Simulation& unchanging() const { return simulation_; }

  private:
    std::mutex mutex_;
    Simulation simulation_;
    bool diverged_ = false;
};

} // namespace echinus::python
