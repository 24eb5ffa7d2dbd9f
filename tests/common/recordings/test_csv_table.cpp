// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// Tables as written by spreadsheets and other programs.
#include <catch2/catch.hpp>

#include <clocale>
#include <random>

#include "common/recordings/csv_table.hpp"

using namespace tread::recordings;
using Catch::Contains;

namespace {

CsvLayout asked(const std::vector<std::string>& columns) {
  CsvLayout layout;
  layout.columns = columns;
  return layout;
}

CsvTable table(const std::string& text, const CsvLayout& layout = {}) {
  return CsvTable(text, "a.csv", layout);
}

/// All numbers in the columns t and x.
std::vector<double> numbers(const std::string& text, const CsvLayout& layout = {}) {
  const CsvTable read = table(text, layout);
  std::vector<double> all;
  for (size_t row = 0; row < read.rows(); ++row)
    for (const char* name : {"t", "x"}) all.push_back(read.number(row, name));
  return all;
}

std::string complaint(const std::string& text, const CsvLayout& layout = {}) {
  try {
    numbers(text, layout);
  } catch (const RecordingError& error) {
    return error.what();
  }
  return "nothing";
}

const std::vector<double> kTwoRows{0.0, 0.5, 1.0, -2.25};

}  // namespace

TEST_CASE("separators are found, and those behind the last column say nothing") {
  CHECK(numbers("t,x\n0,0.5\n1,-2.25\n") == kTwoRows);
  CHECK(numbers("t;x\n0;0.5\n1;-2.25\n") == kTwoRows);
  CHECK(numbers("t\tx\n0\t0.5\n1\t-2.25\n") == kTwoRows);
  CHECK(numbers("t|x\n0|0.5\n1|-2.25\n") == kTwoRows);
  CHECK(numbers("t | x\n0 | 0.5\n1 | -2.25\n") == kTwoRows);
  CHECK(numbers("t  x\n 0 0.5\n1   -2.25 \n") == kTwoRows);
  CHECK(numbers("t, x\n0, 0.5\n1, -2.25\n") == kTwoRows);
  CHECK(numbers("sep=;\nt;x\n0;0.5\n1;-2.25\n") == kTwoRows);
  CHECK(numbers("t,x\n0,0.5,\n1,-2.25,,\n") == kTwoRows);
  CHECK(numbers("t,x,,\n0,0.5,,\n1,-2.25\n,,,\n") == kTwoRows);
  CHECK(complaint("t;x\n0;1\n2;3\n4\n").find("a.csv:4: 1 columns, the header has 2") == 0);
  CHECK(numbers("n,t,note;a,x\n7,0,b;c,0.5\n7,1,d,-2.25\n") == kTwoRows);
}

TEST_CASE("byte order mark, CR LF, CR, empty lines, quotes, and an end without a line end") {
  CHECK(numbers("\xEF\xBB\xBFt,x\r\n0,0.5\r\n1,-2.25\r\n") == kTwoRows);
  CHECK(numbers("t,x\r0,0.5\r\r1,-2.25") == kTwoRows);
  CHECK(numbers("\n\nt,x\n\n0,0.5\n   \n1,-2.25\n\n") == kTwoRows);
  CHECK(numbers("\"t\",\"x\"\n\"0\",\"0.5\"\n\"1\",\"-2.25\"\n") == kTwoRows);
  const CsvTable quoted =
      table("t,note,x\n0,\"a, \"\"b\"\"\r\nc\",0.5\n1,5\" wide,-2.25\n2,\"open,3\n");
  REQUIRE(quoted.rows() == 3);
  CHECK(quoted.text(0, "note") == "a, \"b\" c");
  CHECK(quoted.text(1, "note") == "5\" wide");
  CHECK(quoted.number(1, "x") == -2.25);
  CHECK(quoted.line(1) == 4);
  CHECK(quoted.text(2, "note") == "\"open");
}

TEST_CASE("a header is found behind a # and below other lines") {
  const CsvLayout layout = asked({"t", "x"});
  CHECK(numbers("# t,x\n0,0.5\n1,-2.25\n") == kTwoRows);
  CHECK(numbers("#t x\n0 0.5\n1 -2.25\n") == kTwoRows);
  CHECK(numbers("# t x\n0 0.5\n1 -2.25\n", layout) == kTwoRows);
  CHECK(numbers("% t,x\n0,0.5\n1,-2.25\n", layout) == kTwoRows);
  CHECK(numbers("# made by hand\n#t,x\n# from here\n0,0.5\n# a pause\n1,-2.25\n", layout) ==
        kTwoRows);
  const std::string above = "Logger 2.1; robot \"A\nnumber,7\n\n\"started\",2026-01-01,,\n";
  CHECK(numbers(above + "x;t\n0.5;0\n-2.25;1\n", layout) == kTwoRows);
  const CsvTable read = table(above + "x;t\n0.5;0\n", layout);
  CHECK(read.line(0) == 6);
  CHECK_THROWS_WITH(read.number(0, "y"), "a.csv:5: no column y; there are t, x");
  CHECK(complaint("0,1\n2,3\n") ==
        "a.csv:1: there are numbers where the names of the columns should be; without names, set "
        "header: false in the mapping");
  CHECK(complaint("5,0.5\n6,-2.25\nt,x\n0,0.5\n", layout) ==
        "a.csv:3: a header below rows of numbers; were two files joined? Part them here");
  CsvLayout comma = layout;
  comma.delimiter = ',';
  CHECK(complaint("t;x\n0;1\n", comma) ==
        "a.csv:1: the columns are separated by ';', not by ','; change the delimiter in the "
        "mapping or leave it out");
}

TEST_CASE("a row of units below the header is told and is no row") {
  const CsvLayout layout = asked({"t", "x"});
  for (const char* units : {"s,m,", "[s],[m]", ",m,a text", "ms,1"}) {
    CAPTURE(units);
    const CsvTable read = table("t,x,z\n" + std::string(units) + "\n0,0.5,1\n1,-2.25,1\n", layout);
    CHECK(read.rows() == 2);
    CHECK_FALSE(read.units().empty());
    CHECK(read.number(1, "x") == -2.25);
  }
  const CsvTable read = table("t,x,yaw,cmd\n[ms],m,\xC2\xB0,(%)\n0,1,2,3\n", layout);
  CHECK(read.units() == std::vector<std::string>{"[ms], m, \xC2\xB0, (%)"});
  CHECK(read.unit("t") == "ms");
  CHECK(read.unit("yaw") == "deg");
  CHECK(read.unit("4") == "percent");
  CHECK(table("t,x\n0,nan\n1,2\n", layout).units().empty());
  CHECK(complaint("t,x\n0,1\ns,m\n", layout) ==
        "a.csv:3: column t is 's'; a finite number is needed");
  CHECK(complaint("t,x\na,b\nc,d\ne,f\n", layout) ==
        "a.csv:4: column t is 'e'; a finite number is needed");
}

TEST_CASE("a decimal comma is read where it is asked for or can be nothing else, else named") {
  CsvLayout comma;
  comma.decimal_comma = true;
  CHECK(numbers("t;x\n0,000;0,5\n1;-2,25\n") == kTwoRows);
  CHECK(numbers("t;x\n0;0,500\n1;-2,250\n") == kTwoRows);
  CHECK(numbers("t\tx\n0\t5E-1\n1\t-2,25E+00\n") == kTwoRows);
  CHECK(numbers("t,x\n\"0,0\",\"0,5\"\n\"1,0\",\"-2,25\"\n") == kTwoRows);
  CHECK(numbers("t;x\n1;1,234\n", comma) == std::vector<double>{1.0, 1.234});
  CHECK(numbers("t;x\n1;,5\n", comma) == std::vector<double>{1.0, 0.5});
  CHECK_THAT(complaint("t;x\n1;1,234\n"),
             Contains("a.csv:2: column x is '1,234'; a decimal comma needs decimal_comma: true"));
  CHECK_THAT(complaint("t;x\n1.5;0,5\n"), Contains("column x is '0,5'; a decimal comma needs"));
  CHECK_THAT(complaint("t;x\n1;0,5\n2;1.234,5\n"), Contains("'1.234,5'; numbers must be written"));
  CHECK_THAT(complaint("t;x\n1;1.234\n", comma), Contains("'1.234'; the others have a decimal"));
  CHECK(complaint("t,x\n0,000,0,500\n") ==
        "a.csv:2: 4 columns, the header has 2: decimal commas between commas? Export it with ; or "
        "tabs between the columns");
}

TEST_CASE("numbers are read as programs write them, whatever the locale is") {
  const auto x = [](const std::string& field) { return table("t;x\n0;" + field).number(0, "x"); };
  CHECK(x(".65") == 0.65);
  CHECK(x("+1.5") == 1.5);
  CHECK(x("-.5") == -0.5);
  CHECK(x("007") == 7.0);
  CHECK(x("2.") == 2.0);
  CHECK(x(" 1.5e-3 ") == 0.0015);
  CHECK(x("1E+02") == 100.0);
  for (const char* bad :
       {"+-1", "-+1", "1 2", "0x10", "1e", "e5", ".", "1e999", "--1", "1.5.2", "1f"})
    CHECK_THROWS_AS(x(bad), RecordingError);
  for (const char* grouped : {"1,234,567", "1,234.5", "1'234.5", "12 345",
                              "1\xC2\xA0"
                              "234"})
    CHECK_THROWS_WITH(x(grouped), Contains("without separators of thousands"));
  CHECK_THROWS_WITH(x("12:34:56.7"), Contains("a time of day in seconds"));
  // A locale with a decimal comma, if installed, must not change anything.
  const std::string before = std::setlocale(LC_NUMERIC, nullptr);
  std::setlocale(LC_NUMERIC, "de_DE.UTF-8");
  CHECK(x("1.5") == 1.5);
  std::setlocale(LC_NUMERIC, before.c_str());
}

TEST_CASE("what says that nothing was measured is no number") {
  for (const char* word : {"", "nan", "-nan", "NaN", "-nan(ind)", "nan(0x7)", "inf", "-Inf", "N/A",
                           "#N/A", "NULL", "none", "-1.#IND00", "1.#QNAN", "-"}) {
    CAPTURE(word);
    const CsvTable read = table("t,x\n0," + std::string(word) + "\n");
    CHECK(read.missing(0, "x"));
    CHECK_FALSE(read.missing(0, "t"));
    CHECK_THROWS_WITH(read.number(0, "x"), Contains("a finite number is needed"));
  }
  for (const char* word : {"0", "-1", "nano", "infra", "x"})
    CHECK_FALSE(table("t,x\n0," + std::string(word) + "\n").missing(0, "x"));
}

TEST_CASE("text in another encoding and lost bytes are named") {
  const std::string wide{"t\0,\0x\0\n\0", 8};
  CHECK_THAT(complaint("\xFF\xFE" + wide), Contains("a.csv: is UTF-16 text; save it as UTF-8"));
  CHECK_THAT(complaint(wide), Contains("a.csv: is UTF-16 text"));
  CHECK(complaint(std::string("t,x\n0,1\n\0\0\0\0", 12)) ==
        "a.csv:3: contains NUL bytes, as after a power failure; remove them (tr -d '\\000')");
  CHECK(complaint("") == "a.csv: cannot be read or is empty; give a CSV file with a header line");
  CHECK(complaint("\n# t\n\n") ==
        "a.csv: cannot be read or is empty; give a CSV file with a header line");
  CHECK(complaint("t,x\n") == "a.csv:1: no rows after the header; is the file truncated?");
}

TEST_CASE("a header that comes again between rows is named, one that is a comment is none") {
  CHECK(complaint("t,x\n0,0.5\n1,-2.25\nt,x\n0,0.5\n") ==
        "a.csv:4: the header comes again: are these two drives, joined? Part them here");
  CHECK(complaint("note,t,x\na,0,0.5\nnote,t,x\nb,0,0.5\n").find("a.csv:3: the header") == 0);
  CHECK(numbers("# t x\n0 0.5\n# t x\n1 -2.25\n") == kTwoRows);
}

TEST_CASE("a row of another length is named as what it is") {
  CHECK(complaint("t,x,z\n0,1\n") ==
        "a.csv:2: 2 columns, the header has 3; is the file truncated?");
  CHECK(complaint("t,x\n0,1\n0,1,2\n") ==
        "a.csv:3: 3 columns, the header has 2; is a name missing, or does a text hold the "
        "separator ',' without quotes around it?");
  CsvLayout bare;
  bare.header = false;
  CHECK(complaint("0,1\n0,1,2\n", bare).find("the first line has 2") != std::string::npos);
}

TEST_CASE("the worth of the last digit shows numbers that a spreadsheet has rounded") {
  const auto last = [](const std::string& rows) { return table("t,x\n" + rows).lastDigit("t"); };
  CHECK(last("1.76414E+12,0\n1.76414E+12,0\n") == 1e7);
  CHECK(last("\"1,76414E+12\",0\n") == 1e7);
  CHECK(last("2E3,0\n1.5e+03,0\n") == 100.0);
  CHECK(last("1.76414E+12,0\n1764140000050,0\n") == 0.0);
  CHECK(last("nan,0\n1.5E-03,0\n") == Approx(1e-4));
  CHECK(last("12,0\n13,0\n") == 0.0);
}

TEST_CASE("a damaged table is read or refused in one line, never worse") {
  std::mt19937_64 random(5);
  const std::string good = "# a\nt;x;note\ns;m;-\n0,5;1,5;\"a;b\"\n1,5;nan;\n2,5;+.5;c;\n";
  size_t refused = 0;
  for (int i = 0; i < 4000; ++i) {
    std::string text = good;
    for (size_t n = 1 + random() % 4; n > 0; --n)
      text[random() % text.size()] = "\n\r\";,#. \t0eE-\xEF"[random() % 15];
    for (const CsvLayout& layout : {CsvLayout{}, asked({"t", "x"})}) {
      const std::string said = complaint(text, layout);
      refused += said == "nothing" ? 0 : 1;
      CHECK(said.find('\n') == std::string::npos);
      CHECK(said.size() < 400);
    }
  }
  CHECK(refused > 1000);
}
