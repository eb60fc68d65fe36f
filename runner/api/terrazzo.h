#pragma once

/// The whole C++ interface. See examples/guide/programs.md.
#include "core/image/image_facts.h"
#include "core/image/image_limits.h"
#include "core/image/image_ops.h"
#include "core/image_io/image_file.h"
#include "core/material/material.h"
#include "core/node/node.h"
#include "nodes/common/registry.h"
#include "runner/api/job.h"
#include "runner/api/plugin.h"
#include "runner/api/session.h"
