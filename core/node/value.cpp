#include "core/node/value.h"

#include "core/exemplar/appearance.h"
#include "core/exemplar/features.h"

namespace terrazzo {

const Digest& digest_of(const Value& value) {
  return std::visit([](const auto& v) -> const Digest& { return v->digest(); }, value);
}

}  // namespace terrazzo
