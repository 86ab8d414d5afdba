// kind = "shadows". On each scene the methods take turns, repetition by repetition (A B C, A B C,
// ...), so that a machine that slows down or speeds up on the way does so for all of them. On a
// path they do so in every frame.
#include <fmt/format.h>

#include <bit>
#include <memory>
#include <optional>

#include "experiments/gbuffer/gbuffer.hpp"
#include "experiments/measure/accuracy.hpp"
#include "experiments/measure/pictures.hpp"
#include "experiments/measure/scene_input.hpp"
#include "experiments/measure/session.hpp"

namespace experiments::measure {
namespace {

/// A method at work on one scene.
struct Contestant {
    const config::Method* config;
    std::unique_ptr<shadows::Method> method{};  ///< none once it has failed
    shadows::Visibility visible{};              ///< last answer
};

/// One bit per point with geometry.
std::vector<std::uint32_t> geometry_mask(const shadows::Points& points) {
    std::vector<std::uint32_t> mask(points.count() / 32);
    for (std::uint32_t i = 0; i < points.count(); ++i)
        if (points.host().primitive[i] != shadows::kNoPrimitive) mask[i / 32] |= 1u << (i % 32);
    return mask;
}

void add(structures::Samples& samples, const structures::Samples& more) {
    samples.insert(samples.end(), more.begin(), more.end());
}

/// Build and query once; the samples of both and their sum.
structures::Samples answer(Contestant& contestant, const SceneInput& input,
                           const shadows::Points& points) {
    contestant.method->expect(points);
    structures::Samples samples = contestant.method->build(input.light);
    const structures::Samples asked = contestant.method->query(points, contestant.visible);
    if (contestant.visible.words.size() != points.count() / 32)
        throw std::runtime_error(fmt::format("answered {} words of points, expected {}",
                                             contestant.visible.words.size(), points.count() / 32));
    add(samples, asked);
    samples.push_back(
        {"total_ms", value_of(samples, "build_ms") + value_of(samples, "query_ms"), "ms"});
    return samples;
}

class SceneRun {
  public:
    SceneRun(Session& session, const config::Scene& scene) : session_(session), scene_(scene) {}

    void run() {
        session_.show_step(scene_.name + ": loading");
        input_ = load_scene(scene_);
        const scenes::View still{input_.camera, input_.light};
        const int steps = session_.steps_of(scene_) / scene_.frames();
        for (int frame = 0; frame < scene_.frames(); ++frame) {
            if (session_.samples.complete({scene_.name, kSceneRows, "", frame, 0})) {
                session_.steps_done += steps;
                continue;
            }
            see(frame, scene_.path ? scene_.path->at(frame, still) : still);
            measure();
        }
    }

  private:
    /// "city", and of a path "city, frame 12".
    std::string where() const {
        return scene_.path ? fmt::format("{}, frame {}", scene_.name, frame_) : scene_.name;
    }
    std::string place(const Contestant& contestant) const {
        return where() + ", " + contestant.config->label();
    }

    /// The frame's points, and the truth about them.
    void see(int frame, const scenes::View& view) {
        frame_ = frame;
        judgement_.reset();
        reference_.clear();
        if (!gbuffer_ || view.camera != input_.camera)
            gbuffer_ = gbuffer::render_gbuffer(session_.device, input_.mesh, view.camera,
                                               scene_.width, scene_.height);
        input_.camera = view.camera;
        input_.light = view.light;
        mask_ = geometry_mask(points());
        if (points().valid_count() == 0)
            session_.progress.note(where() + ": the camera sees no geometry");
        if (!session_.config.truth) return;
        session_.show_step(where() + ": truth");
        judgement_.emplace(session_, where(), input_, points());
    }

    void measure() {
        if (contestants_.empty()) prepare();
        for (int i = 0; i < session_.config.warmup; ++i)
            for (Contestant& contestant : contestants_) attempt(contestant, -1);
        const Contestant& reference = contestants_[session_.config.reference];
        if (reference.method) reference_ = reference.visible.words;
        for (int i = 0; i < session_.config.repeat; ++i)
            for (Contestant& contestant : contestants_) attempt(contestant, i);

        if (session_.config.pictures && (frame_ == 0 || scene_.all_pictures)) draw();
        // A frame with a failure stays open, so that --resume tries it again.
        for (const Contestant& contestant : contestants_)
            if (!contestant.method) return;
        structures::Samples facts{{"gbuffer_ms", gbuffer_->milliseconds, "ms"},
                                  {"points", double(points().valid_count())},
                                  {"triangles", double(input_.mesh.triangle_count())},
                                  {"degenerate", double(input_.report.degenerate)}};
        if (judgement_) add(facts, judgement_->effort());
        session_.samples.append({scene_.name, kSceneRows, "", frame_, 0}, facts);
    }

    const shadows::Points& points() const { return gbuffer_->points; }

    void prepare() {
        for (const config::Method& method : session_.config.methods) {
            Contestant& contestant = contestants_.emplace_back(&method);
            const bool ready = session_.attempt(place(contestant), [&] {
                contestant.method = config::find_row(session_.registries.methods, method.name)
                                        .create(session_.device, method.settings);
                contestant.method->prepare(input_.mesh);
            });
            if (!ready) contestant.method.reset();
        }
    }

    /// One repetition, or a warm-up if `repetition` is negative.
    void attempt(Contestant& contestant, int repetition) {
        const Key key{scene_.name, contestant.config->name, contestant.config->variant, frame_,
                      repetition};
        session_.step(fmt::format("{}  {}  {}", where(), contestant.config->label(),
                                  repetition < 0 ? "warm-up" : fmt::format("#{}", repetition + 1)));
        if (!contestant.method || session_.samples.complete(key)) return;
        const bool done = session_.attempt(place(contestant), [&] {
            structures::Samples samples = answer(contestant, input_, points());
            if (repetition < 0) return;
            count(contestant, samples);
            session_.samples.append(key, samples);
        });
        if (!done) contestant.method.reset();
    }

    void count(const Contestant& contestant, structures::Samples& samples) const {
        double shadowed = 0, differing = 0;
        for (std::size_t w = 0; w < mask_.size(); ++w) {
            const std::uint32_t lit = contestant.visible.words[w];
            shadowed += std::popcount(~lit & mask_[w]);
            if (!reference_.empty()) differing += std::popcount((lit ^ reference_[w]) & mask_[w]);
        }
        samples.push_back({"points", double(points().valid_count())});
        samples.push_back({"shadowed", shadowed});
        if (!reference_.empty()) samples.push_back({"differing_points", differing});
        if (!judgement_) return;
        samples.push_back({"claims_exact", double(contestant.method->claims_exact())});
        add(samples, judgement_->score(contestant.visible));
    }

    void draw() {
        for (Contestant& contestant : contestants_) {
            if (!contestant.method) continue;
            session_.attempt(place(contestant), [&] {
                Pictures pictures{session_.folder, frame_ == 0 ? scene_.name : where(),
                                  contestant.config->name, contestant.config->variant};
                pictures.shaded(points(), contestant.visible, input_.light);
                pictures.visibility(points(), contestant.visible);
                if (judgement_)
                    pictures.errors(points(), contestant.visible, input_.light,
                                    judgement_->mask(contestant.visible));
                else if (!reference_.empty())
                    pictures.difference(points(), contestant.visible, reference_);
                pictures.heat(points(), contestant.method->heat());
            });
        }
    }

    Session& session_;
    const config::Scene& scene_;
    SceneInput input_;  ///< camera and light: of the frame
    int frame_ = 0;
    std::optional<gbuffer::GBuffer> gbuffer_;
    std::vector<std::uint32_t> mask_, reference_;
    std::vector<Contestant> contestants_;
    std::optional<Judgement> judgement_;  ///< none if the config wants no truth
};

}  // namespace

void run_shadows(Session& session) {
    session.attempt_scenes([&](const config::Scene& scene) { SceneRun(session, scene).run(); });
}

}  // namespace experiments::measure
