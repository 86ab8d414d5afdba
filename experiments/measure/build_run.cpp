// kind = "build". The structures take turns, repetition by repetition, as shadow methods do.
#include <fmt/format.h>

#include <memory>

#include "experiments/measure/scene_input.hpp"
#include "experiments/measure/session.hpp"
#include "taskpool/pool/job.hpp"

namespace experiments::measure {
namespace {

struct Contestant {
    const config::Method* config;
    std::unique_ptr<structures::Builder> builder{};  ///< none once it has failed
    std::uint64_t own_bytes = 0;                     ///< device memory taken before the build
};

void create(Session& session, Contestant& contestant, const SceneInput& input) {
    const std::uint64_t before = session.device.allocated_bytes();
    const structures::StructureRow& row =
        config::find_row(session.registries.structures, contestant.config->name);
    contestant.builder = row.create(session.device, contestant.config->settings);
    contestant.builder->prepare(input.mesh);
    contestant.own_bytes = session.device.allocated_bytes() - before;
}

structures::Samples build(Session& session, Contestant& contestant, std::size_t triangle_count) {
    taskpool::gpu::Device& device = session.device;
    const std::uint64_t others = device.allocated_bytes() - contestant.own_bytes;
    device.reset_peak();
    const taskpool::pool::RunStats stats = taskpool::pool::run(device, contestant.builder->job());
    const std::uint64_t peak = device.peak_bytes() - others;
    contestant.own_bytes = device.allocated_bytes() - others;
    // A builder without device memory works on the host, where the launch's GPU time says nothing.
    const bool on_host = contestant.builder->required_bytes(triangle_count) == 0;
    structures::Samples samples = {{"build_ms", on_host ? stats.wall_ms : stats.gpu_ms, "ms"},
                                   {"wall_ms", stats.wall_ms, "ms"}};
    if (!on_host) {
        samples.push_back({"launches", double(stats.launches)});
        samples.push_back({"memory_bytes", double(peak), "bytes"});
    }
    // A builder that measures one of these itself (on the host, say) knows better.
    for (structures::Sample& sample : contestant.builder->metrics()) {
        std::erase_if(samples, [&](const auto& s) { return s.metric == sample.metric; });
        samples.push_back(std::move(sample));
    }
    return samples;
}

void check(Session& session, const std::string& place, Contestant& contestant) {
    session.attempt(place, [&] {
        const std::vector<std::string> faults = contestant.builder->validate();
        if (!faults.empty())
            throw std::runtime_error(fmt::format("the structure is invalid ({} faults): {}",
                                                 faults.size(), faults.front()));
    });
}

void save_trace(Session& session, const std::string& place, Contestant& contestant) {
    const std::string trace = contestant.builder->trace();
    if (trace.empty()) return;
    std::filesystem::create_directories(session.folder.traces());
    write_text(session.folder.traces() / (file_name(place) + ".json"), trace);
}

void run_scene(Session& session, const config::Scene& scene) {
    session.show_step(scene.name + ": loading");
    const SceneInput input = load_scene(scene);
    std::vector<Contestant> contestants;
    const std::size_t failures = session.failures.size();
    const auto place = [&](const Contestant& c) { return scene.name + ", " + c.config->label(); };

    for (const config::Method& method : session.config.methods) {
        Contestant& contestant = contestants.emplace_back(&method);
        if (!session.attempt(place(contestant), [&] { create(session, contestant, input); }))
            contestant.builder.reset();
    }
    for (int i = -session.config.warmup; i < session.config.repeat; ++i) {
        for (Contestant& contestant : contestants) {
            const Key key{scene.name, contestant.config->name, contestant.config->variant, 0, i};
            session.step(fmt::format("{}  {}  {}", scene.name, contestant.config->label(),
                                     i < 0 ? "warm-up" : fmt::format("#{}", i + 1)));
            if (!contestant.builder || session.samples.complete(key)) continue;
            const bool done = session.attempt(place(contestant), [&] {
                const structures::Samples samples =
                    build(session, contestant, input.mesh.triangle_count());
                if (i >= 0) session.samples.append(key, samples);
            });
            if (!done) contestant.builder.reset();
        }
    }
    for (Contestant& contestant : contestants)
        if (contestant.builder) {
            check(session, place(contestant), contestant);
            save_trace(session, place(contestant), contestant);
        }
    // A scene with a failure stays open, so that --resume tries it again.
    if (session.failures.size() != failures) return;
    session.samples.append({scene.name, kSceneRows, "", 0, 0},
                           {{"triangles", double(input.mesh.triangle_count())},
                            {"degenerate", double(input.report.degenerate)}});
}

}  // namespace

void run_builds(Session& session) {
    session.attempt_scenes([&](const config::Scene& scene) { run_scene(session, scene); });
}

}  // namespace experiments::measure
