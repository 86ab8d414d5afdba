// Splines and paths: through every key, smooth, still where nothing moves.
#include "experiments/scenes/path.hpp"

#include <gmock/gmock.h>

#include "experiments/scenes/shapes.hpp"
#include "experiments/scenes/spline.hpp"

namespace experiments::scenes {
namespace {

using structures::geometry::Light;
using testing::HasSubstr;

Camera camera_at(Random& random) {
    return {glm::vec3(10.0 * random.direction()),
            glm::vec3(random.direction()),
            {0, 1, 0},
            float(random.uniform(30, 60))};
}

TEST(Splines, PassThroughTheirKnotsAndHaveNoCorners) {
    Random random(5);
    std::vector<glm::dvec3> knots(6);
    for (glm::dvec3& knot : knots) knot = random.direction();
    for (std::size_t i = 0; i < knots.size(); ++i)
        EXPECT_LT(glm::distance(on_spline<glm::dvec3>(knots, double(i)).point, knots[i]), 1e-14);
    for (std::size_t i = 1; i + 1 < knots.size(); ++i) {
        const glm::dvec3 in = on_spline<glm::dvec3>(knots, double(i) - 1e-9).slope;
        const glm::dvec3 out = on_spline<glm::dvec3>(knots, double(i) + 1e-9).slope;
        EXPECT_LT(glm::distance(in, out), 1e-7);
    }
}

TEST(Splines, OfKnotsOnALineAtEqualDistancesAreTheLine) {
    const glm::dvec3 from(1, 2, 3), step(0.5, -1, 2);
    std::vector<glm::dvec3> knots;
    for (int i = 0; i < 5; ++i) knots.push_back(from + double(i) * step);
    for (double at = 0; at <= 4; at += 0.125)
        EXPECT_LT(glm::distance(on_spline<glm::dvec3>(knots, at).point, from + at * step), 1e-13);
}

TEST(Paths, MeetEveryKey) {
    Random random(7);
    Path path{41, {}};
    for (int i = 0; i < 5; ++i)
        path.keys.push_back(
            {camera_at(random), Light{Light::Type::point, glm::vec3(random.direction())}});
    EXPECT_EQ(path.fault(), "");
    for (int i = 0; i < 5; ++i) {
        const View view = path.at(10 * i, {});
        EXPECT_LT(glm::distance(view.camera.eye, path.keys[i].camera->eye), 1e-5f);
        EXPECT_LT(glm::distance(view.camera.target, path.keys[i].camera->target), 1e-5f);
        EXPECT_NEAR(view.camera.fov_y_degrees, path.keys[i].camera->fov_y_degrees, 1e-4);
        EXPECT_LT(glm::distance(view.light.vector, path.keys[i].light->vector), 1e-6f);
    }
}

TEST(Paths, LeaveStillWhatTheirKeysDoNotHold) {
    Random random(9);
    const View still{camera_at(random), {Light::Type::directional, {0, -1, 0}}};
    const Path lights{
        9,
        {{{}, Light{Light::Type::point, {0, 1, 0}}}, {{}, Light{Light::Type::point, {8, 1, 0}}}}};
    for (int frame = 0; frame < 9; ++frame) {
        EXPECT_EQ(lights.at(frame, still).camera, still.camera);
        EXPECT_EQ(lights.at(frame, still).light.vector, glm::vec3(frame, 1, 0));
    }
    const Path cameras{9, {{camera_at(random), {}}, {camera_at(random), {}}}};
    EXPECT_EQ(cameras.at(4, still).light, still.light);
    EXPECT_NE(cameras.at(4, still).camera, still.camera);
}

TEST(Paths, OfOneKeyOrOneFrameStandStill) {
    Random random(11);
    const Keyframe key{camera_at(random), {}};
    const Path one_key{5, {key}};
    for (int frame = 0; frame < 5; ++frame) EXPECT_EQ(one_key.at(frame, {}).camera, *key.camera);
    const Path one_frame{1, {key, {camera_at(random), {}}}};
    EXPECT_EQ(one_frame.at(0, {}).camera, *key.camera);
    EXPECT_EQ(one_key.fault() + one_frame.fault(), "");
}

TEST(Paths, SayWhatIsWrong) {
    Random random(13);
    const Keyframe camera{camera_at(random), {}}, both{camera_at(random), Light{}};
    const Keyframe down{{}, Light{Light::Type::directional, {0, -1, 0}}};
    const Keyframe up{{}, Light{Light::Type::directional, {0, 1, 0}}};
    EXPECT_THAT(Path{}.fault(), HasSubstr("no keys"));
    EXPECT_THAT((Path{2, {{}}}.fault()), HasSubstr("neither a camera nor a light"));
    EXPECT_THAT((Path{2, {camera, both}}.fault()), HasSubstr("key 2 has a light"));
    EXPECT_THAT((Path{2, {both, camera}}.fault()), HasSubstr("key 2 has no light"));
    EXPECT_THAT((Path{2, {both, down}}.fault()), HasSubstr("key 2 has no camera"));
    EXPECT_THAT((Path{2, {down, {{}, Light{}}}}.fault()), HasSubstr("another type of light"));
    EXPECT_THAT((Path{3, {down, up}}.fault()), HasSubstr("frame 1: the light's direction"));
    EXPECT_EQ((Path{4, {down, up}}.fault()), "");
    Keyframe there = camera, back = camera;  // the eye passes through the target, half way
    there.camera->eye = {0, 0, 1};
    back.camera->eye = {0, 0, -1};
    there.camera->target = back.camera->target = {0, 0, 0};
    EXPECT_THAT((Path{3, {there, back}}.fault()), HasSubstr("frame 1: eye and target"));
}

}  // namespace
}  // namespace experiments::scenes
