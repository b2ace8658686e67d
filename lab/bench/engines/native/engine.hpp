#pragma once

#include <echinus/mesh.hpp>

#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

/// The task of an engine; lab/bench/engines/runners.py defines the contract.
struct Task {
    echinus::TriangleMesh model, cloth; ///< y is up
    bool is_matched = false;            ///< the setup "matched", not "recommended"
    bool with_echinus = false;          ///< beside an engine of others
};

constexpr double kFrameSeconds = 1.0 / 60;
constexpr double kGravity = 9.81; ///< along -y
constexpr double kFriction = 0.5;
constexpr std::uint32_t kMatchedIterations = 10;
constexpr double kMatchedThickness = 0.01; ///< R

/// An engine with the cloth of a task in it.
class Engine {
  public:
    virtual ~Engine() = default;

    virtual std::string name() const = 0;
    virtual std::string version() const = 0;
    virtual std::string configuration() const = 0;
    virtual unsigned substeps() const = 0; ///< of a frame
    /// The names and values of the settings.
    virtual std::map<std::string, std::string> settings() const = 0;

    virtual void run_frame() = 0;
    /// [vertices of the task's cloth]
    virtual std::vector<echinus::Vec3f> positions() const = 0;
};

std::unique_ptr<Engine> make_bullet(const Task& task);
/// @param surfaces  contact of surfaces and with itself, too; not only of particles
std::unique_ptr<Engine> make_echinus(const Task& task, bool surfaces);
