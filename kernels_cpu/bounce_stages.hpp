// The stages of one bounce that a scene calls for, in the order of the rows; compaction is the
// caller's own.
#pragma once

#include "common/stages/stages.h"

namespace diptych {

template<typename Run>
void for_stages_of_bounce(unsigned effects, int bounce, const Run& run)
{
#define RUN_each_bounce(name) run(STAGE_##name);
#define RUN_each_surface(name) RUN_each_bounce(name)
#define RUN_first_bounce(name) \
    if (bounce == 0) run(STAGE_##name);
#define RUN_once(name)
#define RUN_each_layer(name)
#define RUN_at_end(name)
#define RUN(name, body, when, needs)                                                   \
    if (STAGE_##name != STAGE_compact && ((needs) == 0 || (effects & (needs)) != 0)) { \
        RUN_##when(name)                                                               \
    }
    STAGES(RUN)
#undef RUN
#undef RUN_at_end
#undef RUN_once
#undef RUN_each_layer
#undef RUN_first_bounce
#undef RUN_each_surface
#undef RUN_each_bounce
}

}  // namespace diptych
