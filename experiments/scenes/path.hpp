// A way that the camera, the light or both go, frame by frame.
//
//     Path path{60, {{Camera{...}, {}}, {Camera{...}, {}}}};
//     for (int frame = 0; frame < path.frames; ++frame) show(path.at(frame, still));
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "experiments/scenes/camera.hpp"

namespace experiments::scenes {

struct Keyframe {
    std::optional<Camera> camera{};
    std::optional<structures::geometry::Light> light{};
    bool operator==(const Keyframe&) const = default;
};

struct Path {
    int frames = 1;
    /// One at least, evenly spread over the frames, the first at the first and the last at the last
    /// frame. All have what the first one has; lights are of one type.
    std::vector<Keyframe> keys;

    /// Camera and light of a frame, from 0. Eye and target follow Catmull-Rom splines; up, field of
    /// view and light change linearly. What the keys do not have is `still`'s.
    View at(int frame, const View& still) const;
    /// What makes it unusable ("key 3 has no light, ...", "frame 12: eye and target ..."), or
    /// empty.
    std::string fault() const;
    bool operator==(const Path&) const = default;
};

}  // namespace experiments::scenes
