// Shadow rays through Intel Embree 3: the rival on the CPU. README.md lists the settings tried.
//
//     embree         rtcOccluded1, one ray per point
//     embree_packet  rtcOccluded8 or 16, one packet per 4 x 2 or 4 x 4 pixels
//     embree_stream  rtcOccludedNp, one coherent stream per 16 x 4 pixels
#pragma once

#include <memory>

#include "shadows/embree/trace.hpp"
#include "shadows/embree/workers.hpp"
#include "shadows/method.hpp"
#include "structures/embree/scene.hpp"

namespace shadows::embree {

using structures::embree::Quality;

struct Config {
    /// Rays per call: 1, packets of 8 or 16, or streams of 64; 0: the faster packets on this host,
    /// found on a sample of the first query's points before its time is taken.
    std::uint32_t width = 1;
    Quality quality = Quality::medium;
    float bias = 1e-5f;          ///< fraction of the segment at the receiver that is not searched
    unsigned threads = 0;        ///< 0: one per core
    std::uint32_t chunk = 1024;  ///< points a thread takes at once; a multiple of kTilePoints
};

class EmbreeMethod final : public Method {
  public:
    /// Throws std::invalid_argument for another width, or a chunk that is no multiple of a tile.
    explicit EmbreeMethod(const Config& config);

    void prepare(const structures::geometry::TriangleMesh& mesh) override;
    /// build_ms and memory_bytes. The scene serves any light, but is built anew each time. Throws
    /// std::invalid_argument for coordinates that Embree takes no ray at (9e17).
    structures::Samples build(const structures::geometry::Light& light) override;
    /// query_ms, rays, mrays_per_s. Throws std::logic_error before build(), and as build() does for
    /// points out of range.
    structures::Samples query(const Points& points, Visibility& visible) override;

  private:
    /// Milliseconds for every `stride`-th chunk of the points.
    double trace_all(Trace trace, const PointArrays& points, std::uint32_t stride,
                     std::vector<std::uint32_t>& words);
    Trace faster_packets(const PointArrays& points);

    Config config_;
    structures::embree::Scene scene_;
    Workers workers_;
    structures::geometry::Aabb bounds_;  ///< of the scene
    Trace trace_ = nullptr;              ///< null: width 0, not yet decided
    std::unique_ptr<ShadowRays> rays_;
};

}  // namespace shadows::embree
