// SPDX-License-Identifier: Apache-2.0
// All of nearlight: a session puts a scene on devices, looks at it, places virtual point lights and gathers
// their light in pixels or at points. docs/api.md walks through it.
#pragma once

#include "nearlight/animation.h"
#include "nearlight/device.h"
#include "nearlight/error.h"
#include "nearlight/image.h"
#include "nearlight/light_share.h"
#include "nearlight/message.h"
#include "nearlight/scene.h"
#include "nearlight/session.h"
#include "nearlight/settings.h"
#include "nearlight/tev.h"
#include "nearlight/vec3.h"
