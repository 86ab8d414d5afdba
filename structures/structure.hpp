// What every structure offers to the command line, the property tests, the benchmarks and the
// report: one row in the registry and one builder behind it.
//
//     for (const StructureRow& row : structures::registry()) {
//         auto builder = row.create(device, Settings::resolve(row.parameters(), {}));
//         builder->prepare(mesh);
//         taskpool::pool::run(device, builder->job());
//         assert(builder->validate().empty());
//     }
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "structures/geometry/triangle_mesh.hpp"
#include "structures/parameters.hpp"
#include "structures/sample.hpp"
#include "taskpool/gpu/device.hpp"
#include "taskpool/pool/job.hpp"

namespace structures {

class Builder {
  public:
    virtual ~Builder() = default;

    /// Bytes of device memory that building `triangle_count` triangles takes, output included, the
    /// uploaded mesh not; 0 for a builder that works in host memory.
    virtual std::size_t required_bytes(std::size_t triangle_count) const = 0;
    /// Allocates for `mesh` and uploads it; not part of a build's time. The mesh must outlive the
    /// builder's use. An empty mesh is fine.
    virtual void prepare(const geometry::TriangleMesh& mesh) = 0;
    /// One build from the prepared input. Running it again builds again.
    virtual taskpool::pool::Job& job() = 0;
    /// Quality and counters of the finished build (nodes, depth_max, sah_cost, tasks, ...).
    virtual Samples metrics() = 0;
    /// Reads the built structure back and checks every invariant; one line per violation.
    virtual std::vector<std::string> validate() = 0;
    /// A hash of the finished structure's bytes: equal builds have equal fingerprints. 0: it cannot
    /// be read.
    virtual std::uint64_t fingerprint() = 0;
    /// The last build chunk by chunk as Chrome trace-event JSON; empty unless the settings ask for
    /// it.
    virtual std::string trace() { return {}; }
};

struct StructureRow {
    std::string_view name;
    std::string_view summary;
    std::span<const Parameter> (*parameters)();
    std::unique_ptr<Builder> (*create)(taskpool::gpu::Device& device, const Settings& settings);
};

std::span<const StructureRow> registry();

}  // namespace structures
