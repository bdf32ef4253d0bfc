// Putting slices of one picture together.
#pragma once

#include "host/render/checkpoint.hpp"

namespace diptych {

// A film with that many batches, at least those it has; its sums are the same.
Film with_batches(Film film, int batches);

// Throws std::runtime_error (name and name: what; what to do) for another scene, camera, size, seed
// or other settings, and when both hold the same samples.
void expect_mergeable(const CheckpointHead& a, const std::string& name_a, const CheckpointHead& b,
                      const std::string& name_b);

// Adds what is mergeable, in any order. Complete slices that meet become one.
void add_checkpoint(Checkpoint& all, const Checkpoint& more);

// Throw std::runtime_error (name: what; what to do) when a render may not go on from a checkpoint:
// because its subject is another; because its samples begin elsewhere, are more, do not end with a
// whole quantum before the render's end, or were taken by another plan.
void expect_same_subject(const CheckpointHead& head, const std::string& name,
                         const CheckpointSubject& subject);
void expect_same_plan(const CheckpointHead& head, const std::string& name, const Settings& settings,
                      const RenderOptions& options);

// The state to go on from with a render of these options: at the end of the checkpoint's samples or
// within. Throws what expect_same_plan throws.
RenderState continued(Checkpoint checkpoint, const std::string& name, const Settings& settings,
                      const RenderOptions& options);

}  // namespace diptych
