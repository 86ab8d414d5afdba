// What every shadow method offers: a row in the registry and an object that answers, for each
// G-buffer point, whether the light is visible from it.
//
//     auto method = row.create(device, Settings::resolve(row.parameters(), {}));
//     method->prepare(mesh);
//     Samples built = method->build(light);            // build_ms, memory_bytes, ...
//     Samples asked = method->query(points, visible);  // query_ms, ...
#pragma once

#include <memory>
#include <span>
#include <string_view>

#include "shadows/points.hpp"
#include "structures/geometry/light.hpp"
#include "structures/geometry/triangle_mesh.hpp"
#include "structures/parameters.hpp"
#include "structures/sample.hpp"
#include "taskpool/gpu/device.hpp"

namespace shadows {

class Method {
  public:
    virtual ~Method() = default;

    /// Takes the scene: uploads, allocates. Not timed. `mesh` must outlive the method's use.
    virtual void prepare(const structures::geometry::TriangleMesh& mesh) = 0;
    /// Tells which points queries will be about, for methods that leave out what can shadow none of
    /// them: called before build(), whose time includes what that takes. They must outlive the
    /// queries.
    virtual void expect(const Points&) {}
    /// Builds whatever the query walks, for this light. Returns `build_ms` at least.
    virtual structures::Samples build(const structures::geometry::Light& light) = 0;
    /// Answers every point. `visible` gets one bit per point in the order of `points` (bit i % 32
    /// of word i / 32): 1 = lit. Points without geometry get 1. Returns `query_ms` at least.
    virtual structures::Samples query(const Points& points, Visibility& visible) = 0;
    /// Per-point cost of the last query (nodes visited), if the method was asked for statistics:
    /// empty otherwise. Same order as the points.
    virtual std::vector<float> heat() { return {}; }
    /// Whether the method claims the exact answer outside the rounding band.
    virtual bool claims_exact() const { return false; }
};

struct MethodRow {
    std::string_view name;
    std::string_view summary;
    std::span<const structures::Parameter> (*parameters)();
    std::unique_ptr<Method> (*create)(taskpool::gpu::Device& device,
                                      const structures::Settings& settings);
};

std::span<const MethodRow> registry();

}  // namespace shadows
