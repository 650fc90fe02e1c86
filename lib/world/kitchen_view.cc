#include "world/kitchen_view.h"

#include "base/error.h"

namespace synpo {

void render(const KitchenScene&, const KitchenFrame&, int, int, uint8_t*) { fail(Exit::kInternal, "kitchens are not drawn yet"); }

}  // namespace synpo
