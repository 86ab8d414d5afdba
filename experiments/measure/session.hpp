// One run under way: what it measures with, where the numbers go, and what went wrong so far.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "experiments/config/config.hpp"
#include "experiments/measure/progress.hpp"
#include "experiments/measure/run_folder.hpp"
#include "experiments/measure/samples_file.hpp"
#include "experiments/measure/truth_cache.hpp"
#include "shadows/method.hpp"
#include "structures/structure.hpp"

namespace experiments::measure {

/// What the program can measure.
struct Registries {
    std::span<const structures::StructureRow> structures;
    std::span<const shadows::MethodRow> methods;
};

/// The `method` of rows that describe a scene itself. They are written when all else of the scene,
/// or of a frame of its path, is done, so their presence says so.
inline constexpr const char* kSceneRows = "(scene)";

struct Session {
    taskpool::gpu::Device& device;
    const config::Config& config;
    const Registries& registries;
    RunFolder& folder;
    SamplesFile& samples;
    Progress& progress;
    TruthCache& truth_cache;
    std::vector<std::string> failures{};
    int steps_done = 0;
    int steps_total = 0;  ///< set by each kind of experiment

    /// The next step of `steps_total` begins.
    void step(const std::string& what) { progress.step(what, steps_done++, steps_total); }
    /// Says what goes on before it.
    void show_step(const std::string& what) { progress.step(what, steps_done, steps_total); }
    /// Runs `work`. An exception becomes a failure of the run, named by `place`, and false; the run
    /// goes on. Lost devices and unwritable results end it: those exceptions pass.
    bool attempt(const std::string& place, const std::function<void()>& work);
    /// A step per frame, method and repetition.
    int steps_of(const config::Scene& scene) const {
        return scene.frames() * int(config.methods.size()) * (config.warmup + config.repeat);
    }
    /// attempt() on every scene of the config that is not complete.
    void attempt_scenes(const std::function<void(const config::Scene&)>& work);
    /// Notes a failure of the run, one line; the run goes on.
    void fail(const std::string& message);
};

/// kind = "shadows": builds and queries every method on every scene, compares the answers.
void run_shadows(Session& session);
/// kind = "build": builds every structure over every scene, checks and describes the trees.
void run_builds(Session& session);
/// kind = "stability": lets every method answer the scenes of the stress suite. What a method fails
/// is in its samples; a scene about which the judge and the suite differ is a failure of the run.
void run_stability(Session& session);

}  // namespace experiments::measure
