// What this folder adds to the registry of structures.
#include "structures/bvh/gpu_builder.hpp"
#include "structures/bvh/reference_builder.hpp"

namespace structures::bvh {

std::span<const StructureRow> rows() {
    static const StructureRow all[] = {kGpuRow, kReferenceRow};
    return all;
}

}  // namespace structures::bvh
