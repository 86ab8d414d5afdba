// Interpolation between the keys of a path.
#include "experiments/scenes/path.hpp"

#include <fmt/format.h>

#include "experiments/scenes/spline.hpp"

namespace experiments::scenes {
namespace {

using structures::geometry::Light;

/// Of a member of all keys' cameras.
glm::vec3 smooth(const std::vector<Keyframe>& keys, glm::vec3 Camera::*member, double at) {
    std::vector<glm::dvec3> knots;
    for (const Keyframe& key : keys) knots.emplace_back((*key.camera).*member);
    return glm::vec3(on_spline<glm::dvec3>(knots, at).point);
}

}  // namespace

View Path::at(int frame, const View& still) const {
    View view = still;
    if (keys.size() == 1 || frames == 1) {
        view.camera = keys[0].camera.value_or(view.camera);
        view.light = keys[0].light.value_or(view.light);
        return view;
    }
    const double at = double(frame) / (frames - 1) * double(keys.size() - 1);
    const std::size_t before = std::min(static_cast<std::size_t>(at), keys.size() - 2);
    const Keyframe &a = keys[before], &b = keys[before + 1];
    const auto share = static_cast<float>(at - double(before));
    if (a.camera)
        view.camera = {smooth(keys, &Camera::eye, at), smooth(keys, &Camera::target, at),
                       glm::mix(a.camera->up, b.camera->up, share),
                       glm::mix(a.camera->fov_y_degrees, b.camera->fov_y_degrees, share)};
    if (a.light) view.light = {a.light->type, glm::mix(a.light->vector, b.light->vector, share)};
    return view;
}

std::string Path::fault() const {
    if (keys.empty()) return "there are no keys";
    const Keyframe& first = keys[0];
    if (!first.camera && !first.light) return "its keys hold neither a camera nor a light";
    for (std::size_t i = 1; i < keys.size(); ++i) {
        const Keyframe& key = keys[i];
        for (const bool camera : {true, false}) {
            const bool has = camera ? key.camera.has_value() : key.light.has_value();
            const bool had = camera ? first.camera.has_value() : first.light.has_value();
            if (has != had)
                return fmt::format("key {} has {} {}, but key 1 has {}; give it to all or none",
                                   i + 1, has ? "a" : "no", camera ? "camera" : "light",
                                   had ? "one" : "none");
        }
        if (key.light && key.light->type != first.light->type)
            return fmt::format("key {} has another type of light than key 1", i + 1);
    }
    for (int frame = 0; frame < frames; ++frame) {
        const View view = at(frame, {});
        if (std::string fault = view.camera.fault(); first.camera && !fault.empty())
            return fmt::format("frame {}: {}", frame, fault);
        if (first.light && view.light.type == Light::Type::directional &&
            view.light.vector == glm::vec3(0))
            return fmt::format("frame {}: the light's direction has no length", frame);
    }
    return {};
}

}  // namespace experiments::scenes
