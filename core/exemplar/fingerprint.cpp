#include "core/exemplar/fingerprint.h"

namespace terrazzo {

void Fingerprint::add_to(Hasher& h) const {
  h.add("fingerprint").add(cells.width).add(cells.height).add(int64_t(channels.size()));
  for (const Channel& c : channels) {
    h.add(c.map).add(c.channel);
    h.bytes(c.means.data(), c.means.size());
  }
}

}  // namespace terrazzo
