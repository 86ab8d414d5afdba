// Cameras, default views and the file of named views.
#include "experiments/scenes/camera.hpp"

#include "experiments/scenes/shapes.hpp"
#include "experiments/scenes/views_file.hpp"
#include "tests/experiments/scenes_support.hpp"

namespace experiments::scenes {
namespace {

using structures::geometry::Aabb;
using structures::geometry::Light;
using testing::HasSubstr;

glm::vec3 project(const glm::mat4& clip, glm::vec3 point) {
    const glm::vec4 p = clip * glm::vec4(point, 1);
    return glm::vec3(p) / p.w;
}

TEST(Cameras, LookAtTheirTargetWithVulkansAxes) {
    const Camera camera{{0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 90};
    const glm::mat4 clip = camera.view_projection(2, 0.1f);
    EXPECT_EQ(project(clip, {0, 0, 0}), glm::vec3(0, 0, 0.1f / 5));
    // Right is +x, up is -y (the top of the picture), the corner of the picture at 1.
    const glm::vec3 corner = project(clip, {10, 5, 0});
    EXPECT_NEAR(corner.x, 1, 1e-6);
    EXPECT_NEAR(corner.y, -1, 1e-6);
    // Reversed depth: 1 at the near plane, 0 infinitely far.
    EXPECT_NEAR(project(clip, {0, 0, 4.9f}).z, 1, 1e-5);
    EXPECT_NEAR(project(clip, {0, 0, -1e9f}).z, 0, 1e-9);
    EXPECT_LT((clip * glm::vec4(0, 0, 6, 1)).w, 0);
}

TEST(Cameras, PixelRaysAndProjectionAgree) {
    Random random(3);
    for (int i = 0; i < 200; ++i) {
        SCOPED_TRACE(i);
        Camera camera;
        camera.eye = glm::vec3(10.0 * random.direction());
        camera.target = camera.eye + glm::vec3(random.direction());
        camera.up = glm::vec3(random.direction());
        camera.fov_y_degrees = static_cast<float>(random.uniform(10, 120));
        if (camera.fault() != "") continue;
        const int width = 64, height = 36;
        const glm::mat4 clip = camera.view_projection(float(width) / height, 0.01f);
        const int x = static_cast<int>(random.index(width)),
                  y = static_cast<int>(random.index(height));
        const PixelRay ray = camera.pixel_ray(x, y, width, height);
        EXPECT_EQ(ray.origin, camera.eye);
        EXPECT_NEAR(glm::length(ray.direction), 1, 1e-6);
        const glm::vec3 p = project(clip, ray.origin + 7.f * ray.direction);
        EXPECT_NEAR((p.x + 1) / 2 * width, x + 0.5, 2e-3);
        EXPECT_NEAR((p.y + 1) / 2 * height, y + 0.5, 2e-3);
    }
}

TEST(Cameras, NameTheirFaults) {
    EXPECT_EQ(Camera{}.fault(), "");
    EXPECT_THAT((Camera{{1, 2, 3}, {1, 2, 3}}.fault()), HasSubstr("same point"));
    EXPECT_THAT((Camera{{0, 5, 0}, {0, 0, 0}}.fault()), HasSubstr("up points along"));
    EXPECT_THAT((Camera{{0, 0, 5}, {0, 0, 0}, {0, 0, 0}}.fault()), HasSubstr("up has no length"));
    EXPECT_THAT((Camera{{0, 0, NAN}, {0, 0, 0}}.fault()), HasSubstr("finite"));
    for (const float fov : {0.f, -1.f, 180.f, NAN})
        EXPECT_THAT((Camera{{0, 0, 5}, {0, 0, 0}, {0, 1, 0}, fov}.fault()), HasSubstr("fov"));
}

TEST(DefaultView, ShowsTheWholeBoxWithTheLightOutside) {
    const Aabb boxes[] = {{{-1, -1, -1}, {1, 1, 1}},
                          {{100, 0, -50}, {1100, 1, 900}},
                          {{1e-6f, 0, 0}, {2e-6f, 1e-6f, 3e-6f}},
                          {{-1e18f, -1e18f, -1e18f}, {1e18f, 1e18f, 1e18f}},
                          {{1e6f, 1e6f, 1e6f}, {1e6f, 1e6f, 1e6f}},
                          {{0, 0, 0}, {0, 0, 0}},
                          {}};
    for (const Aabb& box : boxes) {
        const View view = default_view(box);
        EXPECT_EQ(view.camera.fault(), "");
        EXPECT_EQ(view.light.type, Light::Type::point);
        if (box.empty()) continue;
        Aabb with_light = box;
        with_light.grow(view.light.vector);
        EXPECT_NE(with_light, box);
        const glm::mat4 clip = view.camera.view_projection(16.f / 9, 1e-3f);
        for (int k = 0; k < 8; ++k) {
            const glm::vec3 p =
                project(clip, {k & 1 ? box.lower.x : box.upper.x, k & 2 ? box.lower.y : box.upper.y,
                               k & 4 ? box.lower.z : box.upper.z});
            EXPECT_LT(std::abs(p.x), 1);
            EXPECT_LT(std::abs(p.y), 1);
        }
    }
}

class ViewFiles : public SceneFiles {
  protected:
    std::string view_error(const std::string& text, const std::string& scene,
                           const std::string& view) const {
        const auto path = write("views.json", text);
        try {
            load_view(path, scene, view);
        } catch (const LoadError& error) {
            EXPECT_EQ(std::string(error.what()).rfind(path.string() + ": ", 0), 0u);
            return error.what();
        }
        ADD_FAILURE() << "it loads";
        return {};
    }
};

std::string views(const std::string& camera, const std::string& light) {
    return R"({"scenes":{"a.ply":{"up_axis":"y","views":{"one":{"camera":)" + camera +
           R"(,"light":)" + light + R"(},"two":{}}},"b.ply":{}}})";
}

const std::string kCamera = R"({"eye":[1,2,3],"target":[0,0,0],"up":[0,0,1],"fov_y_degrees":60})";
const std::string kLight = R"({"type":"point","position":[4,5,6]})";

TEST_F(ViewFiles, Load) {
    const View view =
        load_view(write("v.json", views(kCamera, kLight)), "some/folder/a.ply", "one");
    EXPECT_EQ(view, (View{{{1, 2, 3}, {0, 0, 0}, {0, 0, 1}, 60}, {Light::Type::point, {4, 5, 6}}}));
    const View sun =
        load_view(write("v.json", views(R"({"eye":[1,2,3],"target":[0,0,0]})",
                                        R"({"type":"directional","direction":[0,-1,0.5]})")),
                  "a.ply", "one");
    EXPECT_EQ(sun.camera.fov_y_degrees, 45);
    EXPECT_EQ(sun.camera.up, glm::vec3(0, 1, 0));
    EXPECT_EQ(sun.light, (Light{Light::Type::directional, {0, -1, 0.5f}}));
}

TEST_F(ViewFiles, Faults) {
    const std::string good = views(kCamera, kLight);
    EXPECT_THAT(view_error(good, "c.ply", "one"),
                HasSubstr("no scene 'c.ply'; there are: a.ply, b.ply"));
    EXPECT_THAT(view_error(good, "a.ply", "three"),
                HasSubstr("no view of 'a.ply' called 'three'; there are: one, two"));
    EXPECT_THAT(view_error(good, "b.ply", "one"), HasSubstr("has no entry 'views'"));
    EXPECT_THAT(view_error(good, "a.ply", "two"),
                HasSubstr("scene 'a.ply', view 'two': malformed"));
    EXPECT_THAT(view_error("{}", "a.ply", "one"), HasSubstr("has no entry 'scenes'"));
    EXPECT_THAT(view_error("{", "a.ply", "one"), HasSubstr("malformed"));
    EXPECT_THAT(view_error(views(R"({"eye":[1,2],"target":[0,0,0]})", kLight), "a.ply", "one"),
                HasSubstr("view 'one': malformed"));
    EXPECT_THAT(view_error(views(R"({"eye":[0,0,0],"target":[0,0,0]})", kLight), "a.ply", "one"),
                HasSubstr("same point"));
    EXPECT_THAT(view_error(views(kCamera, R"({"type":"disc"})"), "a.ply", "one"),
                HasSubstr("light type 'disc'"));
    EXPECT_THAT(
        view_error(views(kCamera, R"({"type":"directional","direction":[0,0,0]})"), "a.ply", "one"),
        HasSubstr("no length"));
    EXPECT_THROW(load_view(folder_ / "none.json", "a.ply", "one"), LoadError);
}

}  // namespace
}  // namespace experiments::scenes
