#include "points/points.hpp"
#include "support/expectations.hpp"
#include "support/random_points.hpp"
#include "support/temporary_folder.hpp"

#include <echinus/error.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>

using namespace echinus;
namespace fs = std::filesystem;

namespace {

std::string npy_file(int version, const std::string& dict, const std::string& elements) {
    std::string size(version == 1 ? 2 : 4, '\0');
    for (std::size_t i = 0; i < size.size(); ++i) size[i] = static_cast<char>(dict.size() >> 8 * i);
    return std::string("\x93NUMPY") + static_cast<char>(version) + '\0' + size + dict + elements;
}

std::string dict_text(const std::string& descr, bool fortran_order, const std::string& shape) {
    return "{'descr': " + descr + ", 'fortran_order': " + (fortran_order ? "True" : "False") +
           ", 'shape': " + shape + ", }   \n";
}

template <typename T>
std::string elements(const std::vector<Vec3f>& points, bool fortran_order) {
    std::vector<T> numbers;
    if (fortran_order) {
        for (const Vec3f& p : points) numbers.push_back(static_cast<T>(p.x));
        for (const Vec3f& p : points) numbers.push_back(static_cast<T>(p.y));
        for (const Vec3f& p : points) numbers.push_back(static_cast<T>(p.z));
    } else {
        for (const Vec3f& p : points) numbers.insert(numbers.end(), {T(p.x), T(p.y), T(p.z)});
    }
    return {reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(T)};
}

std::vector<Vec3f> some_points(std::size_t count) {
    test::Random random(static_cast<unsigned>(count));
    std::vector<Vec3f> points(count);
    for (Vec3f& point : points) point = test::in_cube(random, 10);
    return points;
}

std::string shape_of(const std::vector<Vec3f>& points) {
    return "(" + std::to_string(points.size()) + ", 3)";
}

class Points : public test::TemporaryFolderTest {
  protected:
    /// All points of a file as floats, asked for in blocks of an odd size.
    static std::vector<Vec3f> read(const fs::path& path) {
        auto input = std::make_unique<Input>(path);
        const auto source = format_of_points(path, *input) == TableFormat::Npy
                                ? open_npy_points(std::move(input))
                                : open_csv_points(std::move(input));
        std::vector<Vec3f> points;
        std::vector<Vec3d> block(7);
        while (const std::size_t count = source->read(block))
            for (std::size_t i = 0; i < count; ++i) points.emplace_back(block[i]);
        EXPECT_EQ(points.size(), source->count());
        return points;
    }
    std::vector<Vec3f> read_npy(const std::string& content) const {
        return read(write("points.npy", content));
    }
    std::vector<Vec3f> read_csv(const std::string& content) const {
        return read(write("points.csv", content));
    }

    void expect_refusal(const std::string& name, const std::string& content, ErrorCode code,
                        const std::string& words) const {
        const fs::path file = write(name, content);
        test::expect_error(code, words, [&] { read(file); });
        test::expect_error(code, file.string(), [&] { read(file); });
    }
};

} // namespace

TEST_F(Points, ReadTheSameFromEveryArrayThatNumpyMayWrite) {
    for (const std::size_t count : {0, 1, 7, 20}) {
        const std::vector<Vec3f> points = some_points(count);
        for (const int version : {1, 2, 3}) {
            for (const bool fortran_order : {false, true}) {
                const auto file = [&](const char* descr, const std::string& data) {
                    return npy_file(version, dict_text(descr, fortran_order, shape_of(points)), data);
                };
                EXPECT_EQ(read_npy(file("'<f4'", elements<float>(points, fortran_order))), points);
                EXPECT_EQ(read_npy(file("'<f8'", elements<double>(points, fortran_order))), points);
            }
        }
    }
}

TEST_F(Points, AreRefusedByNameWhenTheArrayIsOfAnotherKind) {
    const std::string data(24, '\0');
    const auto refuse = [&](const std::string& descr, const std::string& shape, const std::string& words) {
        expect_refusal("p.npy", npy_file(1, dict_text(descr, false, shape), data), ErrorCode::WrongFormat,
                       words);
    };
    refuse("'>f4'", "(2, 3)", "big-endian");
    refuse("'<i4'", "(2, 3)", "type '<i4'");
    refuse("'<f2'", "(2, 3)", "type '<f2'");
    refuse("'<c8'", "(1, 3)", "type '<c8'");
    refuse("'|O'", "(1, 3)", "type '|O'");
    refuse("[('x', '<f4'), ('y', '<f4')]", "(1, 3)", "type '[('x'");
    refuse("'<f4'", "(6,)", "shape [6]");
    refuse("'<f4'", "(3, 2)", "shape [3, 2]");
    refuse("'<f4'", "(1, 2, 3)", "shape [1, 2, 3]");
    refuse("'<f4'", "()", "shape []");
}

TEST_F(Points, AreRefusedWhenTheHeaderIsNotOne) {
    const std::string data(24, '\0');
    const auto refuse = [&](const std::string& dict) {
        expect_refusal("p.npy", npy_file(1, dict, data), ErrorCode::Damaged, ".npy header");
    };
    refuse("");
    refuse("{}");
    refuse("{'descr': '<f4'}");
    refuse("{'descr': '<f4', 'fortran_order': False}");
    refuse("{'descr': '<f4', 'fortran_order': Maybe, 'shape': (2, 3)}");
    refuse("{'descr': '<f4', 'fortran_order': False, 'shape': (2, 3)} and more");
    refuse("{'descr': '<f4', 'fortran_order': False, 'shape': (2, 3), 'more': 1}");
    refuse("{'descr': '<f4', 'fortran_order': False, 'shape': (-2, 3)}");
    refuse("{'descr': '<f4', 'fortran_order': False, 'shape': (99999999999999999999, 3)}");
    refuse("{'descr': '<f4, 'fortran_order': False, 'shape': (2, 3)}");
    refuse("{'descr': [[[['<f4', 'fortran_order': False, 'shape': (2, 3)}");
    refuse(std::string(1000, '['));
}

TEST_F(Points, AreRefusedWhenTheFileIsNoArray) {
    expect_refusal("p.npy", "", ErrorCode::WrongFormat, "it is empty");
    expect_refusal("p.npy", "1,2,3\n", ErrorCode::WrongFormat, "does not begin with");
    expect_refusal("p.npy", "\x93NUMP", ErrorCode::WrongFormat, "does not begin with");
    expect_refusal("p.npy", npy_file(9, "", ""), ErrorCode::WrongFormat, "version 9");
    const std::string claims_4_gigabytes = std::string("\x93NUMPY\x02\0", 8) + "\xff\xff\xff\xff";
    expect_refusal("p.npy", claims_4_gigabytes, ErrorCode::Damaged, "claims 4294967295 bytes");
}

TEST_F(Points, AreRefusedWhenTheFileIsShorterOrLongerThanPromised) {
    const std::vector<Vec3f> points = some_points(3);
    for (const bool fortran_order : {false, true}) {
        const std::string file = npy_file(1, dict_text("'<f4'", fortran_order, shape_of(points)),
                                          elements<float>(points, fortran_order));
        for (std::size_t size = 0; size < file.size(); ++size) {
            EXPECT_THROW(read_npy(file.substr(0, size)), Error) << size << " bytes";
        }
        expect_refusal("p.npy", file + "x", ErrorCode::Damaged, "continues after them");
    }
}

TEST_F(Points, DoNotMakeUsReserveWhatAHeaderOnlyPromises) {
    for (const char* shape : {"(1000000000000, 3)", "(18446744073709551615, 3)"}) {
        for (const bool fortran_order : {false, true}) {
            for (const char* descr : {"'<f4'", "'<f8'"}) {
                const std::string file =
                    npy_file(1, dict_text(descr, fortran_order, shape), std::string(240, '\0'));
                expect_refusal("p.npy", file, ErrorCode::Damaged, "ends before");
            }
        }
    }
}

TEST_F(Points, WithstandEveryValueOfEveryByteOfTheHeader) {
    const std::vector<Vec3f> points = some_points(2);
    std::string file =
        npy_file(1, dict_text("'<f4'", false, shape_of(points)), elements<float>(points, false));
    const std::size_t header_size = file.size() - 24;
    for (std::size_t i = 0; i < header_size; ++i) {
        const char original = file[i];
        for (int value = 0; value < 256; value += 3) {
            file[i] = static_cast<char>(value);
            try {
                EXPECT_LE(read_npy(file).size(), points.size());
            } catch (const Error& error) {
                EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
            }
        }
        file[i] = original;
    }
}

TEST_F(Points, AreReadFromLinesOfText) {
    const std::vector<Vec3f> expected{{1, 2, 3}, {-0.5F, 1e-3F, 40}};
    EXPECT_EQ(read_csv("1,2,3\n-0.5,1e-3,40\n"), expected);
    EXPECT_EQ(read_csv("1,2,3\n-0.5,1e-3,40"), expected);
    EXPECT_EQ(read_csv("x,y,z\r\n1,2,3\r\n-0.5,1e-3,40\r\n"), expected);
    EXPECT_EQ(read_csv("\xef\xbb\xbf\"x\",\"y\",\"z\"\n 1 ,\t2 , +3\n\n# comment\n-0.5,0.001,4e1\n\n"),
              expected);
    EXPECT_EQ(read(write("no_ending", "1,2,3\n-0.5,1e-3,40\n")), expected);
}

TEST_F(Points, MayBeNoNumbersAsTheyMayInAnArray) {
    const std::vector<Vec3f> points = read_csv("nan,inf,-inf\n");
    ASSERT_EQ(points.size(), 1u);
    EXPECT_TRUE(std::isnan(points[0].x) && std::isinf(points[0].y) && std::isinf(points[0].z));
}

TEST_F(Points, AreRefusedWithTheNumberOfTheLine) {
    const auto refuse = [&](const std::string& text, const std::string& words) {
        expect_refusal("p.csv", text, ErrorCode::Damaged, words);
    };
    refuse("1,2,3\n4,5\n", "line 2 is '4,5'");
    refuse("1,2,3\n\n# c\n4,5,6,7\n", "line 4");
    refuse("1,2,3\nx,y,z\n", "line 2");
    refuse("x,y,z\na,b,c\n", "line 2");
    refuse("x,y\n", "line 1");
    refuse("1,2,3abc\n", "line 1");
    refuse("1,2,\n", "line 1");
    refuse("1;2;3\n",
           "line 1 is '1;2;3', not three numbers x,y,z; separate them by commas, not by semicolons");
    refuse("1,5;2,5;3,5\n", "separate them by commas, not by semicolons, and write a decimal point");
    refuse("1 2 3\n", "separate them by commas, not by blanks");
    refuse("1\t2 \t3\n", "separate them by commas, not by tabs");
    refuse("1,2,3,4\n", "not three numbers x,y,z; it has 4 columns");
    expect_refusal("p.csv",
                   std::string("\xff\xfe"
                               "1\0,\0",
                               6),
                   ErrorCode::WrongFormat, "the text is UTF-16; save it as UTF-8");
    refuse("1e999,0,0\n", "line 1");
    refuse(std::string("1,2,3\n\0\x01\xff,2,3\n", 15), "line 2 is '???,2,3'");
    refuse(std::string(100'000, '9'), "...'");
    expect_refusal("p.csv", "", ErrorCode::WrongFormat, "neither points nor a line of names");
    expect_refusal("p.csv", "# c\n\n", ErrorCode::WrongFormat, "neither points nor a line of names");
}

TEST_F(Points, MayBeNoneInTextAsInAnArray) {
    EXPECT_TRUE(read_csv("x,y,z\n").empty());
    EXPECT_TRUE(read_csv("# c\r\n\"x\",\"y\",\"z\"\r\n\n").empty());
}

TEST_F(Points, AreRefusedFromALineWithoutEnd) {
    expect_refusal("p.csv", std::string(Input::kMaxLineLength + 1, '9'), ErrorCode::Damaged,
                   "a line has more than 1048576 characters");
    if (!fs::exists("/dev/zero")) GTEST_SKIP() << "this system has no /dev/zero";
    test::expect_error(ErrorCode::Damaged, "a line has more than", [] { read("/dev/zero"); });
}

TEST_F(Points, AreRefusedWhenThereAreMoreThanMemoryShouldHold) {
    if (!fs::exists("/dev/zero")) GTEST_SKIP() << "this system has no /dev/zero";
    const Input input("/dev/zero");
    EXPECT_NO_THROW(require_room_for(input, kMaxPointsInMemory));
    test::expect_error(ErrorCode::Unreadable, "/dev/zero: it has more than 100000000 points",
                       [&] { require_room_for(input, kMaxPointsInMemory + 1); });
}

TEST_F(Points, GetAnswersAsPackedRecords) {
    const std::vector<Contact> contacts{{{1, 2, 3}, {0, 0, 1}, 0.5F, 7, true},
                                        {{4, 5, 6}, {}, 0, kNoIndex, false}};
    const fs::path target = path("answers.npy");
    const auto writer = open_answers(target, TableFormat::Npy, contacts.size(), {});
    writer->write({.contacts = {contacts.data(), 1}});
    writer->write({.contacts = {contacts.data() + 1, 1}});
    EXPECT_FALSE(fs::exists(target)) << "nothing may appear before the end";
    writer->finish();

    Input input(target);
    const NpyHeader header = read_npy_header(input);
    EXPECT_EQ(header.descr, "[('inside', '|u1'), ('depth', '<f4'), ('normal', '<f4', (3,)), "
                            "('point', '<f4', (3,)), ('face', '<i4'), ('certain', '|u1')]");
    EXPECT_EQ(header.shape, std::vector<std::uint64_t>{2});
    constexpr std::size_t kRecordSize = 34;
    EXPECT_EQ((fs::file_size(target) - 2 * kRecordSize) % 64, 0u);
    for (const Contact& contact : contacts) {
        char record[kRecordSize];
        ASSERT_EQ(input.read(record, kRecordSize), kRecordSize);
        EXPECT_EQ(record[0] != 0, contact.inside);
        float floats[7];
        std::memcpy(floats, record + 1, sizeof floats);
        EXPECT_EQ(floats[0], contact.depth);
        EXPECT_EQ((Vec3f{floats[1], floats[2], floats[3]}), contact.normal);
        EXPECT_EQ((Vec3f{floats[4], floats[5], floats[6]}), contact.point);
        std::uint32_t face = 0;
        std::memcpy(&face, record + 29, sizeof face);
        EXPECT_EQ(face, contact.face);
        EXPECT_EQ(record[33] != 0, contact.certain);
    }
    EXPECT_TRUE(input.at_end());
}

TEST_F(Points, GetAnswersAsText) {
    const std::vector<Contact> contacts{{{1, 2, 0.1F}, {0, 0, 1}, 0.5F, 7, true}};
    const auto writer = open_answers(path("answers.csv"), TableFormat::Csv, contacts.size(), {});
    writer->write({.contacts = contacts});
    writer->finish();
    std::ifstream file(path("answers.csv"));
    std::string names, values;
    std::getline(file, names);
    std::getline(file, values);
    EXPECT_EQ(names, "inside,depth,normal_x,normal_y,normal_z,point_x,point_y,point_z,face,certain");
    EXPECT_EQ(values, "1,0.5,0,0,1,1,2,0.1,7,1");
}
