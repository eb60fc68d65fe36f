#pragma once

namespace terrazzo::python {

/// From now on, what nodes in Python open is told to checked runs (runner/engine/checked.h). Files of Python itself and
/// of its packages do not count, nor does source code: `uses` and `version` answer for that. Needs Python's lock.
void tell_opened_files();

}  // namespace terrazzo::python
