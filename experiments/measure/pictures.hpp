// The pictures of one method's answer on one scene, in the run's images/ folder.
#pragma once

#include <span>
#include <string>

#include "experiments/image/image.hpp"
#include "experiments/measure/run_folder.hpp"
#include "shadows/points.hpp"
#include "shadows/truth/score.hpp"
#include "structures/geometry/light.hpp"

namespace experiments::measure {

/// Each function writes its files and enters them in the manifest's `images`, replacing an earlier
/// picture of the same kind. Throws OutputError.
class Pictures {
  public:
    Pictures(RunFolder& folder, std::string scene, std::string method, std::string variant);

    /// What the camera sees: diffuse grey surfaces under the light, darkened where shadowed. PNG.
    void shaded(const shadows::Points& points, const shadows::Visibility& visible,
                const structures::geometry::Light& light);
    /// 1 where lit or without geometry, 0 where shadowed. EXR and PNG.
    void visibility(const shadows::Points& points, const shadows::Visibility& visible);
    /// Where the answer differs from the reference: red if only this method finds light, blue if
    /// only the reference does. EXR (1, -1, 0) and PNG; nothing if they agree.
    void difference(const shadows::Points& points, const shadows::Visibility& visible,
                    std::span<const std::uint32_t> reference);
    /// Where the answer differs from the truth, `mask` row by row from the top. EXR with a channel
    /// for each kind of error, 1 where it is; PNG with a dot for each over the shaded picture, red
    /// where falsely lit, blue where falsely shadowed, yellow within the rounding band. Nothing if
    /// there is none.
    void errors(const shadows::Points& points, const shadows::Visibility& visible,
                const structures::geometry::Light& light,
                std::span<const shadows::truth::Error> mask);
    /// Cost per point, 0 dark to the 99th percentile bright. EXR and PNG; nothing if `cost` is
    /// empty.
    void heat(const shadows::Points& points, const std::vector<float>& cost);

  private:
    void save(const std::string& kind, const image::Image& exact,
              std::span<const std::string> channels, const image::Image& preview);
    void enter(const std::string& kind, const std::string& file);

    RunFolder& folder_;
    std::string scene_, method_, variant_, stem_;
};

}  // namespace experiments::measure
