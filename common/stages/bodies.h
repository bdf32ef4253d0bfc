// The bodies of all shared stages, for who wants them at once; a new stage adds its line here and
// its row in stages.h.
#pragma once

#include "common/stages/accumulate.h"
#include "common/stages/accumulate_aovs.h"
#include "common/stages/add_emission.h"
#include "common/stages/decide_alpha.h"
#include "common/stages/evaluate_surface.h"
#include "common/stages/generate_paths.h"
#include "common/stages/record_features.h"
#include "common/stages/sample_bsdf.h"
#include "common/stages/sample_light.h"
#include "common/stages/scale_light.h"
