// kind = "stability": every method of the config on every scene of the stress suite, varied.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>

#include "experiments/measure/session.hpp"
#include "experiments/stability/judge.hpp"
#include "experiments/stability/suite.hpp"
#include "experiments/stability/variations.hpp"

namespace experiments::measure {
namespace {

using stability::JudgedScene;
using stability::Marks;
using stability::StressTest;
using stability::WrongPoint;
using structures::geometry::Light;

/// What a method did in one test, over all instances: its samples.
struct Tally {
    int instances = 0, failed = 0, exceptions = 0;
    double points = 0, false_lit = 0, false_shadowed = 0, unexpected = 0, ambiguous = 0;
    double incomplete = 0, slowest_ms = 0;
    std::optional<WrongPoint> worst{};

    structures::Samples samples(bool claims_exact) const {
        structures::Samples list = {{"stability_passed", failed == 0 ? 1.0 : 0.0},
                                    {"instances", double(instances)},
                                    {"instances_failed", double(failed)},
                                    {"exceptions", double(exceptions)},
                                    {"claims_exact", claims_exact ? 1.0 : 0.0},
                                    {"points", points},
                                    {"false_lit", false_lit},
                                    {"false_shadowed", false_shadowed},
                                    {"unexpected", unexpected},
                                    {"ambiguous", ambiguous},
                                    {"incomplete", incomplete},
                                    {"slowest_ms", slowest_ms, "ms"}};
        if (worst) {
            list.push_back({"worst_x", worst->position.x});
            list.push_back({"worst_y", worst->position.y});
            list.push_back({"worst_z", worst->position.z});
        }
        return list;
    }
};

/// A method of the config; its object answers one scene after another.
struct Contestant {
    const config::Method* config;
    const shadows::MethodRow* row;
    std::unique_ptr<shadows::Method> method{};
    bool claims_exact = false;
    bool created = false;  ///< once; whatever is thrown later counts as its failure
    bool broken = false;   ///< cannot even be created
    Tally tally{};         ///< of the test under way
};

class StabilityRun {
  public:
    explicit StabilityRun(Session& session) : session_(session) {
        for (const config::Method& method : session.config.methods)
            contestants_.push_back(
                {&method, &config::find_row(session.registries.methods, method.name)});
        const std::vector<int>& selected = session.config.stability->tests;
        for (const StressTest& test : stability::suite())
            if (std::find(selected.begin(), selected.end(), test.number) != selected.end())
                tests_.push_back(&test);
    }

    /// A test takes a step per type of light.
    void run() {
        session_.steps_total = 0;
        for (const StressTest* test : tests_)
            session_.steps_total += int(test->light_types().size());
        int steps = 0;
        for (const StressTest* test : tests_) {
            session_.steps_done = steps;
            session_.attempt(test->label(), [&] { run_test(*test); });
            steps += int(test->light_types().size());
        }
    }

  private:
    Key key(const StressTest& test, const Contestant& contestant) const {
        return {test.label(), contestant.config->name, contestant.config->variant, 0, 0};
    }

    /// Those that still have to answer this test, ready to do so.
    std::vector<Contestant*> contestants(const StressTest& test) {
        std::vector<Contestant*> list;
        for (Contestant& contestant : contestants_) {
            contestant.tally = {};
            if (contestant.broken || session_.samples.complete(key(test, contestant))) continue;
            if (!contestant.created)
                contestant.broken =
                    !session_.attempt(contestant.config->label(), [&] { create(contestant); });
            if (!contestant.broken) list.push_back(&contestant);
        }
        return list;
    }

    void create(Contestant& contestant) {
        if (contestant.method) return;
        contestant.method = contestant.row->create(session_.device, contestant.config->settings);
        contestant.claims_exact = contestant.method->claims_exact();
        contestant.created = true;
    }

    void run_test(const StressTest& test) {
        const std::vector<Contestant*> players = contestants(test);
        const Key facts{test.label(), kSceneRows, "", 0, 0};
        double points = 0, instances = 0, triangles = 0;
        for (const Light::Type type : test.light_types()) {
            const char* light = type == Light::Type::point ? "point light" : "directional light";
            session_.step(fmt::format("{}, {}", test.label(), light));
            if (players.empty() && session_.samples.complete(facts)) continue;
            for (const stability::Scene& scene : test.build(type)) {
                for (const stability::Variation& variation : stability::variations(
                         *session_.config.stability, session_.config.seed, test.most)) {
                    const std::string place =
                        fmt::format("{}{}{}, {}", light, scene.name.empty() ? "" : ", ", scene.name,
                                    variation.label());
                    run_instance(test, place, vary(scene, variation), players);
                    ++instances;
                    points += double(scene.points.size());
                }
                triangles = std::max(triangles, double(scene.mesh.triangle_count()));
            }
        }
        for (Contestant* player : players)
            if (player->tally.instances > 0)
                session_.samples.append(key(test, *player),
                                        player->tally.samples(player->claims_exact));
        // A test that somebody could not take stays open, so that --resume tries it again.
        if (session_.samples.complete(facts) ||
            std::any_of(contestants_.begin(), contestants_.end(),
                        [](const Contestant& c) { return c.broken; }))
            return;
        session_.samples.append(
            facts, {{"instances", instances}, {"points", points}, {"triangles", triangles}});
    }

    /// `place` tells the instances of a test apart.
    void run_instance(const StressTest& test, const std::string& place,
                      const stability::Scene& scene, const std::vector<Contestant*>& players) {
        std::optional<JudgedScene> judged;
        try {
            judged = judge(scene);
        } catch (const std::exception& error) {
            throw std::runtime_error(fmt::format("{}: {}", place, error.what()));
        }
        const shadows::Points points(session_.device, judged->image.arrays, judged->image.width,
                                     judged->image.height);
        for (Contestant* player : players) {
            ++player->tally.instances;
            std::string why;
            try {
                create(*player);
                why = answer(*player, *judged, points);
            } catch (const taskpool::gpu::Error& error) {
                if (error.result == VK_ERROR_DEVICE_LOST) throw;
                why = give_up(*player, error);
            } catch (const std::exception& error) {
                why = give_up(*player, error);
            }
            if (why.empty()) continue;
            // The first of a test is told in full; the rest is in the counts.
            if (player->tally.failed++ == 0)
                session_.progress.note(fmt::format("{}, {}: {} fails: {}", test.label(), place,
                                                   player->config->label(), why));
        }
    }

    static std::string give_up(Contestant& player, const std::exception& error) {
        ++player.tally.exceptions;
        player.method.reset();  // who knows in what state
        return fmt::format("error: {}", error.what());
    }

    /// Lets the method answer; why that is wrong, or nothing.
    static std::string answer(Contestant& player, const JudgedScene& judged,
                              const shadows::Points& points) {
        using Clock = std::chrono::steady_clock;
        Tally& tally = player.tally;
        shadows::Visibility visible;
        const Clock::time_point begin = Clock::now();
        player.method->prepare(judged.scene.mesh);
        player.method->expect(points);
        player.method->build(judged.scene.light);
        const structures::Samples asked = player.method->query(points, visible);
        const std::chrono::duration<double, std::milli> time = Clock::now() - begin;
        tally.slowest_ms = std::max(tally.slowest_ms, time.count());
        const Marks marks = judged.mark(visible);
        const double incomplete = value_of(asked, "incomplete");
        tally.points += marks.score.points;
        tally.false_lit += marks.score.false_lit;
        tally.false_shadowed += marks.score.false_shadowed;
        tally.ambiguous += marks.score.ambiguous;
        tally.unexpected += marks.unexpected;
        tally.incomplete += incomplete;
        if (marks.worst && (!tally.worst || marks.worst->severity > tally.worst->severity))
            tally.worst = marks.worst;
        if (incomplete > 0) return fmt::format("{} points left without an answer", incomplete);
        if (marks.passed()) return {};
        const WrongPoint& worst = *marks.worst;
        return fmt::format("{} false lit, {} false shadowed, {} unexpected; ({}, {}, {}) is not {}",
                           marks.score.false_lit, marks.score.false_shadowed, marks.unexpected,
                           worst.position.x, worst.position.y, worst.position.z,
                           worst.called_lit ? "lit" : "shadowed");
    }

    Session& session_;
    std::vector<Contestant> contestants_;
    std::vector<const StressTest*> tests_;
};

}  // namespace

void run_stability(Session& session) { StabilityRun(session).run(); }

}  // namespace experiments::measure
