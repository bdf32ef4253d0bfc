// A render's state as a file: what it is a render of, which samples of which blocks are done, and
// the film's sums. Little-endian. The parts, in order:
//   "DIPTYCHK", format version and length of the header (uint32 each)
//   header: JSON text, padded to 8 bytes; its checksum (uint64)
//   the film's arrays, then those of every slice's blocks, as long as the header says
//   checksum of everything before (uint64)
#pragma once

#include "backends/scene_data.hpp"
#include "host/render/render.hpp"

#include <string>
#include <vector>

namespace diptych {

inline constexpr unsigned checkpoint_version = 3;

// What two checkpoints must share to belong to one picture.
struct CheckpointSubject {
    std::string program;     // name and version
    std::string scene;       // SHA-256 of its buffers and textures; not of what backends add
    Settings settings = {};  // samples: 0 unless a texture reads the number
    std::vector<TextureAov> aovs = {};
};

// scene: before Backend::upload().
CheckpointSubject checkpoint_subject(const SceneData& scene, const std::string& program);

// In what two subjects differ, in words ("seed (1 and 2), camera"); empty when in nothing.
std::string difference_between(const CheckpointSubject& a, const CheckpointSubject& b);

// Samples [first, end) of a picture's plan, how far its blocks have come, and the targets that they
// are rendered to (RenderOptions).
struct Slice {
    int first = 0;
    int end = 0;
    Schedule schedule{};
    double error = 0;
    bool is_timed = false;
    bool is_unbiased = false;
    image::Viewer viewer = {};  // for whom blocks are done
};

// What a render with these options will have done: nothing yet.
Slice slice_of(const RenderOptions& options);
std::vector<Quantum> plan_of(const Slice& slice);

// All of a checkpoint but the sums.
struct CheckpointHead {
    CheckpointSubject subject;
    std::vector<std::string> backends;  // those that had a part in it
    int block_shift = BLOCK_SHIFT;
    std::vector<Slice> slices;  // ascending, apart from each other; one, but for merged ones
    int planned = 0;            // samples of the whole picture; 0: not known
    double seconds = 0;         // of rendering, summed
    unsigned long long rays = 0;
    unsigned long long paths = 0;
};

struct Checkpoint {
    CheckpointHead head;
    Film film;
};

// End of the furthest sample that any block of a slice has; `first` when none has any.
int done_end(const Slice& slice);
// Every block has come to the end, or to its error target.
bool is_complete(const Slice& slice);

class SafeFile;
// Writes, does not put in place. Throws std::runtime_error.
void write_checkpoint(SafeFile& file, const CheckpointHead& head, const Film& film);

// Throws std::runtime_error (path: what; what to do) for whatever is not such a file, whole and of
// this version.
Checkpoint read_checkpoint(const std::string& path);
// The same of its head alone; whether its sums are whole remains unknown.
CheckpointHead read_checkpoint_head(const std::string& path);
// The part of its quanta that is done, 0 to 1; the second from a file's header alone, throwing
// likewise.
double fraction_done(const CheckpointHead& head);
double fraction_done(const std::string& path);

}  // namespace diptych
