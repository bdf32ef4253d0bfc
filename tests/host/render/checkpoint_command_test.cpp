// What a user does with checkpoints: kills renders, goes on, merges, and gives what does not fit.
#include "tests/host/commands/program.hpp"

#include <gtest/gtest.h>

#include <csignal>
#include <fstream>
#include <map>
#include <random>
#include <sys/file.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <unistd.h>

namespace {

std::string bytes_of_file(const std::string& path)
{
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

class CheckpointCommand : public testing::Test {
protected:
    // A small picture, by many dispatches; of an option that comes twice the last is meant.
    Outcome render(const std::vector<std::string>& more, const RunOptions& options = {})
    {
        std::vector<std::string> all = {"--size",   "48x32", "--samples",     "320",
                                        "--memory", "1M",    "--threads",     "1",
                                        "--env",    "none",  "--reproducible"};
        all.insert(all.end(), more.begin(), more.end());
        std::map<std::string, std::string> values;
        for (size_t k = 0; k < all.size(); ++k) {
            const bool is_alone = k + 1 == all.size() || all[k + 1][0] == '-';
            values[all[k]] = is_alone ? "" : all[k + 1];
            k += is_alone ? 0 : 1;
        }
        std::vector<std::string> words = {"render"};
        for (const auto& [name, value] : values) {
            words.push_back(name);
            if (!value.empty()) words.push_back(value);
        }
        return run_diptych(words, options);
    }

    void expect_refusal(const Outcome& outcome, const std::string& words)
    {
        SCOPED_TRACE(outcome.text());
        EXPECT_EQ(outcome.exit_code, 2);
        const std::vector<std::string> lines = outcome.err_lines();
        ASSERT_EQ(lines.size(), 1u);
        EXPECT_EQ(lines[0].find("diptych: "), 0u);
        EXPECT_NE(lines[0].find(words), std::string::npos) << words;
        EXPECT_NE(lines[0].find(';'), std::string::npos) << "says what to do";
    }

    TestFolder folder_;
    std::string file_ = folder_ / "a.checkpoint";
    std::string picture_ = folder_ / "a.exr";
    std::vector<std::string> kept_ = {"--checkpoint", file_, "--every", "0.001s",
                                      "--quiet",      "-o",  picture_};
};

// A render, and how often it is killed at random moments.
struct Work {
    const char* name;
    int kills;
    std::vector<std::string> flags;
};

class KilledRender : public CheckpointCommand, public testing::WithParamInterface<Work> {
protected:
    Outcome render_work(const std::vector<std::string>& more, const RunOptions& options = {})
    {
        std::vector<std::string> words = GetParam().flags;
        words.insert(words.end(), more.begin(), more.end());
        return render(words, options);
    }
};

TEST_P(KilledRender, GivesTheSamePictureHoweverOften)
{
    const std::string expected = folder_ / "expected.exr";
    ASSERT_EQ(render_work({"--quiet", "-o", expected}).exit_code, 0);
    const auto start = std::chrono::steady_clock::now();
    ASSERT_EQ(render_work({"--quiet", "-o", expected}).exit_code, 0);
    const double whole =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();

    std::mt19937 random(3);
    std::uniform_real_distribution<double> moment(0.05 * whole, 0.8 * whole);
    const auto expect_picture = [&](const Outcome& outcome) {
        ASSERT_EQ(outcome.exit_code, 0) << outcome.text();
        EXPECT_EQ(bytes_of_file(picture_), bytes_of_file(expected));
        std::filesystem::remove(file_);
        std::filesystem::remove(picture_);
    };
    int kills = 0, resumed = 0;
    while (kills < GetParam().kills && !HasFatalFailure()) {
        const bool is_begun = std::filesystem::exists(file_);
        const Outcome outcome = render_work(kept_, {.seconds = moment(random)});
        if (!outcome.has_timed_out) {
            expect_picture(outcome);
            continue;
        }
        ++kills;
        resumed += is_begun;
        if (kills % 10 == 0) expect_picture(render_work(kept_));
    }
    EXPECT_GE(resumed, 4) << "hardly any render went on from a checkpoint";
}

INSTANTIATE_TEST_SUITE_P(
    , KilledRender,
    testing::Values(
        Work{"uniform", 20, {}}, Work{"to_an_error", 15, {"--error", "1.5"}},
        Work{"to_a_share", 10, {"--error", "1.5", "--share", "80"}},
        Work{"unbiased", 10, {"--error", "2", "--unbiased"}},
        Work{"on_opencl", 15, {"--backend", "opencl", "--memory", "16M", "--error", "1.5"}}),
    [](const testing::TestParamInfo<Work>& info) { return std::string(info.param.name); });

TEST_F(CheckpointCommand, InterruptedItKeepsWhatIsDoneAndGoesOn)
{
    const std::string expected = folder_ / "expected.exr";
    ASSERT_EQ(render({"--quiet", "--samples", "1024", "-o", expected}).exit_code, 0);
    const std::vector<std::string> words = {"--samples", "1024", "--checkpoint",
                                            file_,       "-o",   picture_};
    const Outcome stopped = render(words, {.wait_for = " left", .signal = SIGTERM});
    ASSERT_EQ(stopped.exit_code, 130) << stopped.text();
    EXPECT_NE(bytes_of_file(picture_), bytes_of_file(expected));
    const Outcome resumed = render(words);
    EXPECT_EQ(resumed.exit_code, 0) << resumed.text();
    EXPECT_NE(resumed.err.find("going on from " + file_), std::string::npos);
    EXPECT_EQ(bytes_of_file(picture_), bytes_of_file(expected));

    const Outcome again = render(words);
    EXPECT_EQ(again.exit_code, 0) << "a complete one gives its picture again";
    EXPECT_EQ(bytes_of_file(picture_), bytes_of_file(expected));
    const std::vector<std::string> files = {"a.checkpoint", "a.exr", "expected.exr"};
    EXPECT_EQ(folder_.files(), files) << "neither lock nor temporary files stay";
}

TEST_F(CheckpointCommand, SlicesMergeToThePictureOfOneRender)
{
    const std::string expected = folder_ / "expected.exr", merged = folder_ / "merged.exr";
    ASSERT_EQ(render({"--quiet", "-o", expected}).exit_code, 0);
    std::vector<std::string> merge = {"merge", "-o", merged, "-o", folder_ / "all.checkpoint"};
    for (const char* range : {"240..320", "0..96", "96..240"}) {
        const std::string slice = folder_ / (std::string(range) + ".checkpoint");
        const Outcome outcome = render({"--range", range, "--checkpoint", slice});
        ASSERT_EQ(outcome.exit_code, 0) << outcome.text();
        merge.push_back(slice);
    }
    EXPECT_EQ(folder_.files().size(), 4u) << "slices write no picture";
    const Outcome outcome = run_diptych(merge);
    ASSERT_EQ(outcome.exit_code, 0) << outcome.text();
    EXPECT_NE(outcome.err.find("together: samples 0..320, by cpu"), std::string::npos);
    const Outcome compared =
        run_diptych({"compare", expected, merged, "--metric", "max", "--max", "0"});
    EXPECT_EQ(compared.exit_code, 0) << compared.text();
    const Outcome errors = run_diptych({"compare", expected, merged, "--layer", "predicted_error",
                                        "--metric", "max", "--max", "0"});
    EXPECT_EQ(errors.exit_code, 0) << errors.text();

    // and goes on as one
    const Outcome more = render({"--samples", "400", "--checkpoint", folder_ / "all.checkpoint",
                                 "--quiet", "-o", picture_});
    ASSERT_EQ(more.exit_code, 0) << more.text();
    ASSERT_EQ(render({"--samples", "400", "--quiet", "-o", expected}).exit_code, 0);
    EXPECT_EQ(bytes_of_file(picture_), bytes_of_file(expected));
}

TEST_F(CheckpointCommand, MergeTellsWhatIsMissingAndRefusesWhatDoesNotFit)
{
    const std::string a = folder_ / "a.checkpoint", b = folder_ / "b.checkpoint";
    const std::string out = folder_ / "out.png";
    ASSERT_EQ(render({"--range", "0..64", "--checkpoint", a, "--quiet"}).exit_code, 0);
    ASSERT_EQ(render({"--range", "128..192", "--checkpoint", b, "--quiet"}).exit_code, 0);
    const Outcome apart = run_diptych({"merge", a, b, "-o", out});
    EXPECT_EQ(apart.exit_code, 0) << apart.text();
    EXPECT_NE(apart.err.find("samples 64..128 are in none of the files"), std::string::npos);
    EXPECT_NE(apart.err.find("samples 192..320 are in none of the files"), std::string::npos)
        << "of what was planned the end is missing";

    const auto refuse = [&](const std::vector<std::string>& words, const std::string& what) {
        ASSERT_EQ(render(words).exit_code, 0);
        expect_refusal(run_diptych({"merge", "--quiet", a, b, "-o", out}), what);
    };
    const auto with = [&](std::vector<std::string> more) {
        more.insert(more.end(), {"--restart", "--checkpoint", b, "--quiet"});
        return more;
    };
    refuse(with({"--range", "48..96"}), a + " and " + b + ": both hold samples 48..64");
    refuse(with({"--range", "64..96", "--seed", "5"}),
           a + " and " + b + ": differ in seed (1 and 5)");
    refuse(with({"--range", "64..96", "--size", "32x48"}), "differ in size");
    refuse(with({"--range", "64..96", "--bounces", "2"}), "differ in bounces");
    refuse(with({"--range", "64..96", "--filter", "box"}), "differ in filter");
    refuse(with({"--range", "64..96", "--eye", "0,1,5", "--target", "0,0,0"}), "camera");
    expect_refusal(run_diptych({"merge", "--quiet", a, folder_ / "none", "-o", out}),
                   "no such file");
    expect_refusal(run_diptych({"merge", "--quiet", a, folder_.write("c", "text"), "-o", out}),
                   "is no checkpoint");
    expect_refusal(run_diptych({"merge", "--quiet", a, "-o", folder_ / "no/folder.exr"}),
                   "check that its folder");
    expect_refusal(run_diptych({"merge", "--quiet", a, "-o", folder_ / "x.gif"}),
                   "x.gif: unknown picture format '.gif'");
    EXPECT_FALSE(std::filesystem::exists(folder_ / "x.gif"));
    const std::string bytes = bytes_of_file(a);
    expect_refusal(
        run_diptych({"merge", "--quiet", a, "-o", folder_.path() / "." / "a.checkpoint"}),
        "is one of the checkpoints to merge");
    EXPECT_EQ(bytes_of_file(a), bytes);
}

TEST_F(CheckpointCommand, MergeWritesWhatItCanAndNamesTheRest)
{
    const std::string a = folder_ / "a.checkpoint", b = folder_ / "b.checkpoint";
    ASSERT_EQ(render({"--range", "0..160", "--checkpoint", a, "--quiet"}).exit_code, 0);
    ASSERT_EQ(render({"--range", "160..320", "--checkpoint", b, "--quiet"}).exit_code, 0);
    const std::string first = folder_ / "x.ck", second = folder_ / "y.ck";
    std::vector<int> locks;
    for (const std::string& busy : {first, second}) {
        locks.push_back(open((busy + ".lock").c_str(), O_RDWR | O_CREAT, 0600));
        ASSERT_EQ(flock(locks.back(), LOCK_EX), 0);
    }
    const Outcome outcome =
        run_diptych({"merge", a, b, "-o", first, "-o", second, "-o", picture_, "--quiet"});
    for (const int lock : locks) close(lock);
    expect_refusal(outcome, first + ": another process is writing it");
    EXPECT_NE(outcome.err.find(second + ": another process is writing it"), std::string::npos);
    EXPECT_TRUE(std::filesystem::exists(picture_));
}

TEST_F(CheckpointCommand, MergeOnAFullDiskWritesWhatIsElsewhere)
{
    const std::string a = folder_ / "a.checkpoint", disk = folder_ / "disk";
    ASSERT_EQ(render({"--range", "0..160", "--checkpoint", a, "--quiet"}).exit_code, 0);
    std::filesystem::create_directory(disk);
    if (mount("none", disk.c_str(), "tmpfs", 0, "size=4k") != 0)
        GTEST_SKIP() << "a small tmpfs may not be mounted here";
    const Outcome outcome = run_diptych(
        {"merge", a, "-o", disk + "/x.exr", "-o", disk + "/x.ck", "-o", picture_, "--quiet"});
    EXPECT_EQ(std::filesystem::is_empty(disk), true);
    umount(disk.c_str());
    expect_refusal(outcome, disk + "/x.exr: could not be written whole");
    EXPECT_NE(outcome.err.find(disk + "/x.ck: could not be written whole"), std::string::npos);
    EXPECT_TRUE(std::filesystem::exists(picture_));
}

TEST_F(CheckpointCommand, NamesAllBackendsThatHaveAPartInIt)
{
    const auto go_on = [&](const char* samples, const char* backend) {
        const Outcome outcome = render({"--samples", samples, "--backend", backend, "--memory",
                                        "16M", "--checkpoint", file_, "-o", picture_});
        EXPECT_EQ(outcome.exit_code, 0) << outcome.text();
        return outcome.err;
    };
    EXPECT_EQ(go_on("128", "cpu").find("was begun on"), std::string::npos);
    EXPECT_NE(go_on("144", "twin").find("was begun on cpu: the picture will be by cpu, twin"),
              std::string::npos);
    EXPECT_NE(go_on("160", "double")
                  .find("was begun on cpu, twin: the picture will be by cpu, double, twin"),
              std::string::npos);
}

// An adaptive one has no number of samples to be a part of.
TEST_F(CheckpointCommand, GoesOnFromBlocksThatAreDone)
{
    const std::vector<std::string> words = {"--error", "20", "--checkpoint", file_};
    ASSERT_EQ(render(words).exit_code, 0);
    const Outcome again = render(words);
    EXPECT_EQ(again.exit_code, 0) << again.text();
    EXPECT_NE(again.err.find("24 of 24 blocks done"), std::string::npos) << again.err;
}

// Programs, files and checkpoints go by what lies between two times, if by times at all.
// Its first samples are taken one, one, two, four at a time, whatever their number.
TEST_F(CheckpointCommand, OfATimedRenderGoesOnFromAnyNumberOfSamples)
{
    const std::vector<std::string> words = {"--checkpoint", file_, "--quiet", "-o", picture_};
    const auto timed = [&](const char* time, const char* samples) {
        std::vector<std::string> all = {"--time", time, "--samples", samples};
        all.insert(all.end(), words.begin(), words.end());
        return render(all);
    };
    const std::string expected = folder_ / "expected.exr";
    ASSERT_EQ(render({"--time", "1000", "--samples", "48", "--quiet", "-o", expected}).exit_code,
              0);
    ASSERT_EQ(timed("0.001", "24").exit_code, 0);
    const Outcome longer = timed("1000", "48");
    EXPECT_EQ(longer.exit_code, 0) << longer.text();
    EXPECT_EQ(bytes_of_file(picture_), bytes_of_file(expected));
}

TEST_F(CheckpointCommand, ClocksMayGoBackwards)
{
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    GTEST_SKIP() << "sanitizers have to be loaded before everything else";
#endif
    const RunOptions backwards{.environment = {{"LD_PRELOAD", BACKWARD_CLOCK}}};
    const std::string expected = folder_ / "expected.exr", merged = folder_ / "merged.exr";
    const std::string b = folder_ / "b.checkpoint";
    ASSERT_EQ(run_program({"date", "+%s"}, backwards).exit_code, 0);
    EXPECT_LT(std::stoll(run_program({"date", "+%s"}, backwards).out), 1);
    ASSERT_EQ(render({"--quiet", "-o", expected}).exit_code, 0);
    const Outcome first = render({"--range", "0..160", "--checkpoint", file_}, backwards);
    ASSERT_EQ(first.exit_code, 0) << first.text();
    const Outcome second = render({"--range", "160..320", "--checkpoint", b}, backwards);
    ASSERT_EQ(second.exit_code, 0) << second.text();
    const Outcome both = run_diptych({"merge", file_, b, "-o", merged}, backwards);
    EXPECT_EQ(both.exit_code, 0) << both.text();
    const Outcome same =
        run_diptych({"compare", expected, merged, "--metric", "max", "--max", "0"});
    EXPECT_EQ(same.exit_code, 0) << same.text();
    const Outcome timed = render({"--time", "1s"}, backwards);
    EXPECT_EQ(timed.exit_code, 0) << timed.text();
}

TEST_F(CheckpointCommand, RefusesToGoOnFromAnotherPicture)
{
    ASSERT_EQ(
        render({"--samples", "144", "--checkpoint", file_, "--quiet", "-o", picture_}).exit_code,
        0);
    const std::string before = bytes_of_file(file_);
    const auto refuse = [&](std::vector<std::string> more, const std::string& what) {
        more.insert(more.begin(), kept_.begin(), kept_.end());
        expect_refusal(render(more), what);
        EXPECT_EQ(bytes_of_file(file_), before) << "what was there stays";
    };
    refuse({"--seed", "2"}, "differ in seed (1 and 2)");
    refuse({"--size", "32x48"}, "differ in size (48x32 and 32x48)");
    refuse({"--samples", "128"}, "holds samples 0..144");
    const Outcome told = render({"--samples", "128", "--checkpoint", file_, "-o", picture_});
    EXPECT_EQ(told.exit_code, 2) << told.text();
    EXPECT_EQ(told.err.find("going on from"), std::string::npos) << told.err;
    refuse({"--samples", "64"}, "samples in a sequence (16 and 64)");
    refuse({"--range", "16..320"}, "holds samples 0..144, not from 16 on");
    refuse({"--pixel", "1,1"}, "--checkpoint: not for a single pixel");
    refuse({"--every", "0"}, "--every 0: not a time");
    refuse({"--every", "soon"}, "--every soon: not a time");
    refuse({"--range", "5..20"}, "--range 5..20: cuts a group of 16");
    refuse({"--range", "16..640"}, "--range 16..640: beyond the last");
    refuse({"--range", "32..16"}, "not a range of samples");
    refuse({"--range", "all"}, "not a range of samples");
    expect_refusal(render({"--restart", "--quiet"}), "--restart: there is no checkpoint");
    expect_refusal(render({"--every", "3s", "--quiet"}), "--every: there is no checkpoint");
    std::ofstream(file_, std::ios::binary) << before.substr(0, before.size() / 2);
    expect_refusal(render(kept_), "cut short");
    std::ofstream(file_, std::ios::binary) << "DIPTYCHK\x09" << before.substr(9);
    expect_refusal(render(kept_), "format version 9");
    EXPECT_EQ(
        render({"--samples", "16", "--restart", "--checkpoint", file_, "--quiet", "-o", picture_})
            .exit_code,
        0)
        << "but begins anew when asked to";
}

TEST_F(CheckpointCommand, IsForOneProcessAtATime)
{
    const int lock = open((file_ + ".lock").c_str(), O_RDWR | O_CREAT, 0600);
    ASSERT_EQ(flock(lock, LOCK_EX), 0);
    expect_refusal(render(kept_), "another process is writing it");
    close(lock);
    EXPECT_EQ(render(kept_).exit_code, 0) << "a lock file without its holder is none";
}

TEST_F(CheckpointCommand, AFolderThatCannotBeWrittenIsAnErrorBeforeTheWork)
{
    expect_refusal(render({"--checkpoint", folder_ / "no/a.checkpoint", "--quiet", "-o", picture_}),
                   "check that its folder");
    if (geteuid() == 0) GTEST_SKIP() << "permissions do not bind root";
    std::filesystem::create_directory(folder_ / "locked");
    std::filesystem::permissions(folder_ / "locked", std::filesystem::perms::owner_read);
    expect_refusal(
        render({"--checkpoint", folder_ / "locked/a.checkpoint", "--quiet", "-o", picture_}),
        "yours to write");
    std::filesystem::permissions(folder_ / "locked", std::filesystem::perms::owner_all);
}

// A file that may not grow beyond a size stands for a disk that is full.
TEST_F(CheckpointCommand, ThatCannotBeWrittenLosesNeitherPictureNorTheOneBefore)
{
    ASSERT_EQ(
        render({"--samples", "16", "--checkpoint", file_, "--quiet", "-o", picture_}).exit_code, 0);
    const std::string before = bytes_of_file(file_), small = bytes_of_file(picture_);
    rlimit old = {};
    getrlimit(RLIMIT_FSIZE, &old);
    // the film of 8 batches does not fit; the picture does
    const rlimit limit = {before.size() + 100000, old.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
    const Outcome outcome = render({"--checkpoint", file_, "--every", "0.001s", "-o", picture_});
    setrlimit(RLIMIT_FSIZE, &old);
    EXPECT_EQ(outcome.exit_code, 2) << outcome.text();
    EXPECT_NE(outcome.err.find("the render goes on and tries again"), std::string::npos);
    EXPECT_NE(outcome.err_lines().back().find(file_ + ": could not be written whole"),
              std::string::npos)
        << outcome.text();
    EXPECT_EQ(bytes_of_file(file_), before);
    EXPECT_NE(bytes_of_file(picture_), small) << "the picture is written all the same";
    EXPECT_EQ(folder_.files(), (std::vector<std::string>{"a.checkpoint", "a.exr"}));
    EXPECT_EQ(render(kept_).exit_code, 0);
}

TEST_F(CheckpointCommand, SurvivesAFullDisk)
{
    const std::string disk = folder_ / "disk";
    std::filesystem::create_directory(disk);
    if (mount("none", disk.c_str(), "tmpfs", 0, "size=400k") != 0)
        GTEST_SKIP() << "a small tmpfs may not be mounted here";
    const std::string file = disk + "/a.checkpoint";
    ASSERT_EQ(
        render({"--samples", "16", "--checkpoint", file, "--quiet", "-o", picture_}).exit_code, 0);
    const std::string before = bytes_of_file(file);
    const Outcome outcome = render({"--checkpoint", file, "--every", "0.001s", "-o", picture_});
    EXPECT_EQ(outcome.exit_code, 2) << outcome.text();
    EXPECT_NE(outcome.err.find("No space left on device"), std::string::npos) << outcome.text();
    EXPECT_EQ(bytes_of_file(file), before);
    umount(disk.c_str());
}

// Neither what is refreshed nor what comes at the end takes the other pictures with it.
TEST_F(CheckpointCommand, PicturesOnAFullDiskLeaveTheOthers)
{
    const std::string disk = folder_ / "disk";
    std::filesystem::create_directory(disk);
    if (mount("none", disk.c_str(), "tmpfs", 0, "size=4k") != 0)
        GTEST_SKIP() << "a small tmpfs may not be mounted here";
    const Outcome outcome = render({"--refresh", "0.001s", "-o", disk + "/b.exr", "--quiet"}, {});
    EXPECT_EQ(outcome.exit_code, 2) << outcome.text();
    EXPECT_NE(outcome.err.find("rendering goes on"), std::string::npos) << outcome.text();
    ASSERT_EQ(run_diptych({"render", "--size", "48x32", "--samples", "16", "--quiet", "-o",
                           disk + "/b.exr", "-o", picture_})
                  .exit_code,
              2);
    EXPECT_TRUE(std::filesystem::exists(picture_));
    umount(disk.c_str());
}

}  // namespace
