// The rasterised G-buffer against ray casting of the same pixels with Embree, and against the
// triangles themselves.
#include "experiments/gbuffer/gbuffer.hpp"

#include <embree3/rtcore.h>
#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <random>

#include "experiments/scenes/mesh_file.hpp"
#include "experiments/scenes/views_file.hpp"
#include "tests/support/gpu_fixture.hpp"

namespace {

using experiments::gbuffer::GBuffer;
using experiments::gbuffer::render_gbuffer;
using experiments::scenes::Camera;
using shadows::kNoPrimitive;
using structures::geometry::TriangleMesh;
using Gbuffer = tests::GpuTest;

/// The ray through any place of the image, in double precision.
struct Rays {
    glm::dvec3 right, up, forward;
    int width, height;
    double size;

    Rays(const Camera& camera, int columns, int rows)
        : forward(glm::normalize(glm::dvec3(camera.target) - glm::dvec3(camera.eye))),
          width(columns),
          height(rows),
          size(std::tan(glm::radians(double(camera.fov_y_degrees)) / 2)) {
        right = glm::normalize(glm::cross(forward, glm::dvec3(camera.up)));
        up = glm::cross(right, forward);
    }
    glm::dvec3 direction(double x, double y) const {
        return glm::normalize(forward + (2 * x / width - 1) * size * width / height * right -
                              (2 * y / height - 1) * size * up);
    }
    double pixel() const { return 2 * size / height; }
};

/// The nearest triangle along a ray.
class Caster {
  public:
    explicit Caster(const TriangleMesh& mesh)
        : device_(rtcNewDevice(nullptr)), scene_(rtcNewScene(device_)) {
        rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
        RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
        auto* vertices = static_cast<glm::vec3*>(rtcSetNewGeometryBuffer(
            geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, mesh.positions.size()));
        std::copy(mesh.positions.begin(), mesh.positions.end(), vertices);
        auto* indices = static_cast<glm::uvec3*>(rtcSetNewGeometryBuffer(
            geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, mesh.triangles.size()));
        std::copy(mesh.triangles.begin(), mesh.triangles.end(), indices);
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene_, geometry);
        rtcReleaseGeometry(geometry);
        rtcCommitScene(scene_);
    }
    ~Caster() {
        rtcReleaseScene(scene_);
        rtcReleaseDevice(device_);
    }
    struct Hit {
        std::uint32_t primitive;
        double distance;
    };
    Hit cast(glm::vec3 eye, glm::vec3 direction) const {
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        RTCRayHit query{};
        query.ray = {eye.x,       eye.y,       eye.z,
                     0,           direction.x, direction.y,
                     direction.z, 0,           std::numeric_limits<float>::infinity(),
                     ~0u,         0,           0};
        query.hit.geomID = query.hit.primID = RTC_INVALID_GEOMETRY_ID;
        rtcIntersect1(scene_, &context, &query);
        return {query.hit.primID, query.ray.tfar};
    }

  private:
    RTCDevice device_;
    RTCScene scene_;
};

double ulp(double x) {
    const auto f = float(std::abs(x));
    return double(std::nextafter(f, std::numeric_limits<float>::infinity())) - f;
}

/// The point lies on its triangle, its normal is the triangle's and faces the eye, and the ray of
/// its pixel passes within 1/64 pixel of it (rounding at an edge).
void check_point(const TriangleMesh& mesh, const Camera& camera, const Rays& rays, glm::vec3 point,
                 glm::vec3 normal, std::uint32_t primitive, int x, int y) {
    const glm::dvec3 a = mesh.corner(primitive, 0), b = mesh.corner(primitive, 1),
                     c = mesh.corner(primitive, 2), p = point, eye = camera.eye;
    const glm::dvec3 n = glm::normalize(glm::cross(b - a, c - a));
    const double reach = std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    // Each coordinate is rounded once: half an ulp each.
    ASSERT_LE(std::abs(glm::dot(n, p - a)), 0.87 * ulp(reach) + 1e-12 * glm::length(b - a));
    for (const auto& [from, to, other] : {std::tuple{a, b, c}, {b, c, a}, {c, a, b}}) {
        const glm::dvec3 inward = glm::normalize(glm::cross(n, to - from));
        const double side =
            glm::dot(inward, p - from) * (glm::dot(inward, other - from) < 0 ? -1 : 1);
        ASSERT_GE(side, -0.87 * ulp(reach) - 1e-12 * reach);
    }
    ASSERT_NEAR(glm::length(glm::dvec3(normal)), 1, 2e-7);
    ASSERT_NEAR(std::abs(glm::dot(n, glm::dvec3(normal))), 1, 2e-7);
    ASSERT_LE(glm::dot(glm::dvec3(normal), a - eye), 1e-6 * glm::length(a - eye));
    const glm::dvec3 direction = rays.direction(x + 0.5, y + 0.5);
    const double distance = glm::length(p - eye);
    const double miss = glm::length(glm::cross(direction, p - eye));
    constexpr double kSubpixel = 1.0 / 64;  // rasterisers snap to 1/256 of a pixel
    ASSERT_LE(miss, kSubpixel * rays.pixel() * distance + 2 * ulp(reach));

    const glm::dvec3 ra = a - eye, rb = b - eye, rc = c - eye;
    const glm::dvec3 volumes(glm::dot(direction, glm::cross(rb, rc)),
                             glm::dot(direction, glm::cross(rc, ra)),
                             glm::dot(direction, glm::cross(ra, rb)));
    const double det = volumes.x + volumes.y + volumes.z;
    if (glm::all(glm::greaterThan(volumes / det, glm::dvec3(1e-3)))) {
        // The camera's matrix is single precision, so its rays turn by up to 1e-7.
        const glm::dvec3 exact = eye + direction * (glm::dot(n, ra) / glm::dot(n, direction));
        const double grazing = std::abs(glm::dot(n, direction));
        ASSERT_LE(glm::length(p - exact), 2 * ulp(reach) + 4e-7 * distance / grazing);
    }
}

/// Whether the ray passes a (prolonged) edge of the triangle within 1/64 pixel: where triangles do
/// not share corners, rounding them to subpixels may open a gap.
bool near_edge(const TriangleMesh& mesh, std::uint32_t primitive, glm::dvec3 eye,
               glm::dvec3 direction, double pixel) {
    for (int k = 0; k < 3; ++k) {
        const glm::dvec3 from = glm::dvec3(mesh.corner(primitive, k)) - eye;
        const glm::dvec3 to = glm::dvec3(mesh.corner(primitive, (k + 1) % 3)) - eye;
        const double sine = glm::dot(direction, glm::normalize(glm::cross(from, to)));
        if (std::abs(sine) <= pixel / 64) return true;
    }
    return false;
}

struct Agreement {
    std::size_t hits = 0, differ = 0;
};

/// Compares every pixel. Where the primitives differ, what stands before the G-buffer's point must
/// end within 1/64 pixel.
Agreement compare(const TriangleMesh& mesh, const Camera& camera, int width, int height) {
    const GBuffer seen =
        render_gbuffer(tests::device(), mesh, camera, std::uint32_t(width), std::uint32_t(height));
    const shadows::PointArrays& points = seen.points.host();
    const Caster caster(mesh);
    const Rays rays(camera, width, height);
    Agreement result;
    std::size_t valid = 0;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const auto at =
                shadows::point_index(std::uint32_t(x), std::uint32_t(y), std::uint32_t(width));
            const std::uint32_t primitive = points.primitive[at];
            const glm::vec3 point(points.x[at], points.y[at], points.z[at]);
            if (primitive == kNoPrimitive) {
                EXPECT_EQ(point, glm::vec3(0));
            } else {
                ++valid;
                check_point(mesh, camera, rays, point, points.normal[at], primitive, x, y);
                if (testing::Test::HasFatalFailure()) {
                    ADD_FAILURE() << fmt::format("at pixel {}, {}", x, y);
                    return result;
                }
            }
            const Caster::Hit hit = caster.cast(camera.eye, rays.direction(x + 0.5, y + 0.5));
            result.hits += hit.primitive != kNoPrimitive;
            if (hit.primitive == primitive) continue;
            ++result.differ;
            // The point is on its triangle and within rounding of the ray: see check_point.
            constexpr double kInfinity = std::numeric_limits<double>::infinity();
            const double distance = primitive == kNoPrimitive
                                        ? kInfinity
                                        : glm::distance(glm::dvec3(point), glm::dvec3(camera.eye));
            const bool explained = hit.distance >= (1 - 1e-5) * distance ||
                                   near_edge(mesh, hit.primitive, camera.eye,
                                             rays.direction(x + 0.5, y + 0.5), rays.pixel());
            EXPECT_TRUE(explained) << fmt::format("pixel {}, {}: G-buffer {}, Embree {}", x, y,
                                                  primitive, hit.primitive);
        }
    EXPECT_EQ(seen.points.valid_count(), valid);  // so the padding holds none
    EXPECT_GE(seen.milliseconds, 0);
    return result;
}

TriangleMesh random_soup(std::uint32_t seed, int count, float size, glm::vec3 center) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> unit(-1, 1);
    const auto vector = [&] { return glm::vec3(unit(random), unit(random), unit(random)); };
    TriangleMesh mesh;
    for (int i = 0; i < count; ++i) {
        const glm::vec3 at = center + vector();
        for (int k = 0; k < 3; ++k) mesh.positions.push_back(at + size * vector());
        mesh.triangles.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
    }
    return mesh;
}

TEST_F(Gbuffer, SeesWhatRaysSeeInRandomScenes) {
    struct Case {
        int triangles, width, height;
        float size;
        glm::vec3 center;
    };
    const Case cases[] = {
        {1, 1, 1, 2, {0, 0, 0}},          {3, 16, 16, 2, {0, 0, 0}},
        {50, 17, 33, 1, {0, 0, 0}},       {300, 160, 90, 0.3f, {5, -7, 11}},
        {2000, 333, 77, 0.1f, {0, 0, 0}}, {300, 64, 200, 0.5f, {1e4f, 2e4f, -3e4f}},
        {20, 4096, 3, 3, {0, 0, 0}},      {20, 3, 4096, 3, {0, 0, 0}}};
    for (std::uint32_t seed = 1; const Case& c : cases) {
        SCOPED_TRACE(fmt::format("seed {}", seed));
        const TriangleMesh mesh = random_soup(seed++, c.triangles, c.size, c.center);
        // Half of the cameras are inside the geometry: triangles pass through the near plane.
        const glm::vec3 offset = seed % 2 ? glm::vec3(0.1f, 0.2f, 0.3f) : glm::vec3(1, 2, 3.5f);
        const Camera camera{c.center + offset, c.center, {0.1f, 1, 0}, 70};
        const Agreement result = compare(mesh, camera, c.width, c.height);
        EXPECT_LE(result.differ, 1 + std::size_t(c.width) * c.height / 250);
    }
}

TEST_F(Gbuffer, SeesWhatRaysSeeInARealScene) {
    const char* folder = std::getenv("GROVE_SCENES");
    if (!folder) GTEST_SKIP() << "GROVE_SCENES is not set: no real scene was looked at";
    const std::filesystem::path file = std::filesystem::path(folder) / "dabrovic_sponza.ply.gz";
    const TriangleMesh mesh = experiments::scenes::load_mesh(file).mesh;
    const auto view = experiments::scenes::load_view(std::filesystem::path(folder) / "views.json",
                                                     file, "atrium_floor");
    const Agreement result = compare(mesh, view.camera, 640, 360);
    EXPECT_GT(result.hits, 220'000u);
    EXPECT_LE(result.differ, 230u);  // a thousandth: pixels whose centre is on an edge
    RecordProperty("differing_pixels", int(result.differ));
}

TEST_F(Gbuffer, NoTrianglesNoPoints) {
    const GBuffer seen = render_gbuffer(tests::device(), {}, Camera{}, 40, 30);
    EXPECT_EQ(seen.points.valid_count(), 0u);
    EXPECT_EQ(seen.points.count(), 3u * 2 * shadows::kTilePoints);
}

TEST_F(Gbuffer, DegenerateTrianglesAreNotSeen) {
    TriangleMesh mesh;
    mesh.positions = {{-1, 0, 0}, {1, 0, 0}, {3, 0, 0}, {-1, -1, -1}, {1, -1, -1}, {0, 2, -1}};
    mesh.triangles = {{0, 1, 2}, {0, 0, 1}, {3, 4, 5}, {1, 1, 1}};
    const GBuffer seen =
        render_gbuffer(tests::device(), mesh, {{0, 0, 3}, {0, 0, 0}, {0, 1, 0}, 60}, 64, 64);
    EXPECT_GT(seen.points.valid_count(), 0u);
    for (std::uint32_t id : seen.points.host().primitive)
        EXPECT_TRUE(id == 2 || id == kNoPrimitive);
}

TEST_F(Gbuffer, AxisAlignedSurfacesKeepTheirCoordinate) {
    TriangleMesh mesh;
    const float height = 0.1f;
    mesh.positions = {{-50, height, -50}, {50, height, -50}, {50, height, 50}, {-50, height, 50}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    const GBuffer seen =
        render_gbuffer(tests::device(), mesh, {{0, 1.7f, 0}, {7, 1, 3}, {0, 1, 0}, 60}, 200, 100);
    const shadows::PointArrays& points = seen.points.host();
    for (std::size_t i = 0; i < points.x.size(); ++i) {
        if (points.primitive[i] == kNoPrimitive) continue;
        EXPECT_EQ(points.y[i], height);
        EXPECT_EQ(points.normal[i], glm::vec3(0, 1, 0));
    }
}

TEST_F(Gbuffer, TwoRunsAgreeInEveryBit) {
    const TriangleMesh mesh = random_soup(99, 5000, 0.3f, {0, 0, 0});
    const Camera camera{{0.5f, 0.2f, 2}, {0, 0, 0}, {0, 1, 0}, 60};
    const auto render = [&] { return render_gbuffer(tests::device(), mesh, camera, 250, 130); };
    const GBuffer first = render(), second = render();
    const shadows::PointArrays &a = first.points.host(), &b = second.points.host();
    EXPECT_TRUE(a.x == b.x && a.y == b.y && a.z == b.z && a.normal == b.normal);
    EXPECT_EQ(a.primitive, b.primitive);
}

TEST_F(Gbuffer, TheUnitOfLengthDoesNotMatter) {
    const auto render = [](float unit) {
        TriangleMesh mesh = random_soup(7, 500, 0.4f, {0, 0, 0});
        for (glm::vec3& position : mesh.positions) position *= unit;
        const Camera camera{unit * glm::vec3(0.5f, 0.2f, 1.5f), {0, 0, 0}, {0, 1, 0}, 60};
        return render_gbuffer(tests::device(), mesh, camera, 120, 80);
    };
    const GBuffer plain = render(1);
    ASSERT_GT(plain.points.valid_count(), 0u);
    for (const float unit : {0x1p-50f, 0x1p50f}) {  // powers of two round nothing
        const GBuffer scaled = render(unit);
        EXPECT_EQ(scaled.points.host().primitive, plain.points.host().primitive);
        EXPECT_EQ(scaled.points.host().normal, plain.points.host().normal);
        std::vector<float> x = plain.points.host().x;
        for (float& value : x) value *= unit;
        EXPECT_EQ(scaled.points.host().x, x);
    }
}

TEST_F(Gbuffer, BadArgumentsAreNamed) {
    EXPECT_THROW(render_gbuffer(tests::device(), {}, Camera{}, 0, 10), std::invalid_argument);
    EXPECT_THROW(render_gbuffer(tests::device(), {}, Camera{}, 10, 4097), std::invalid_argument);
    EXPECT_THROW(render_gbuffer(tests::device(), {}, {{0, 0, 0}, {0, 0, 0}, {0, 1, 0}, 60}, 10, 10),
                 std::invalid_argument);
}

}  // namespace
