#pragma once

namespace terrazzo::python {

/// From now on reports files that Python nodes open to checked runs (runner/engine/checked.h). Ignores files of Python
/// and its packages, and source code, which `uses` and `version` cover. The caller must hold the GIL.
void tell_opened_files();

}  // namespace terrazzo::python
