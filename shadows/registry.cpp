#include "shadows/method.hpp"
namespace shadows {
std::span<const MethodRow> registry() { return {}; }
}  // namespace shadows
