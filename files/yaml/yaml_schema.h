// The schema of a YAML file: which keys it has, what may stand behind each, and where in a struct
// it goes, in which unit. A table of fields is all that a reader writes down; files/yaml/yaml.h
// reads a file by it.

#ifndef DIG_FILES_YAML_YAML_SCHEMA_H
#define DIG_FILES_YAML_YAML_SCHEMA_H

#include <stdbool.h>
#include <stddef.h>

enum dig_yaml_kind {
    DIG_YAML_NUMBER, // a double
    DIG_YAML_WHOLE,  // a signed integer of any size
    DIG_YAML_COUNT,  // an unsigned one
    DIG_YAML_BOOL,
    DIG_YAML_WORD,    // one of some words, as an integer
    DIG_YAML_TEXT,    // an array of characters, in one line; of size 0: any text, not kept
    DIG_YAML_MAPPING, // of other fields
    DIG_YAML_LIST,    // an array of values that are all like one field
    DIG_YAML_ANY      // for people: passed over
};

struct dig_yaml_word {
    const char *word; // NULL: the end
    int         value;
};

/// A key of a mapping, or what the values of a list are like.
struct dig_yaml_field {
    const char        *key; // NULL: the end of the fields
    enum dig_yaml_kind kind;
    bool               optional; // where it is absent the struct keeps its default
    size_t             at, size; // where the value goes in the struct of its mapping, its bytes
    size_t             least;    // characters of a text, values of a list; the size has the most
    size_t             count, given; // 1 more than where a list's length goes (a size_t; 0: it has
                                     // the array's), and whether the key is there (a bool; 0: none)
    const struct dig_yaml_field *of; // the fields of a mapping, the one of a list
    const struct dig_yaml_word  *word;
    double                       low, high; // of a number, as it stands in the file; both 0: any
    double factor; // from there to what is kept; 0: kept as it is; below: its inverse is kept
};

/// A whole file, which is a mapping.
struct dig_yaml_file {
    const struct dig_yaml_field *of;
    size_t                       size;     // of the struct
    size_t                       kept;     // of its beginning, which is what is read; 0: all of it
    const void                  *defaults; // such a struct; NULL: zeroed
};

#define REQUIRED .optional = false
#define OPTIONAL .optional = true

/// A field that goes into the member; what is given behind it is written as in the struct above.
#define FIELD(kind_, key_, type, member, ...)                                                      \
    {                                                                                              \
        .key = (key_), .kind = DIG_YAML_##kind_, .at = offsetof(struct type, member),              \
        .size = sizeof(((struct type *)NULL)->member), __VA_ARGS__                                 \
    }

/// A number or a text, its key the member's name.
#define NUMBER(type, member) FIELD(NUMBER, #member, type, member, REQUIRED)
#define TEXT(type, member)   FIELD(TEXT, #member, type, member, REQUIRED, .least = 1)

/// Notes in a bool whether the key is there.
#define GIVEN(type, member) .given = offsetof(struct type, member) + 1

/// A list of numbers that fills the member, a vector or an array.
#define NUMBERS(key, flag, type, member)                                                           \
    FIELD(LIST, key, type, member, flag, .of = &dig_yaml_number)

/// Two numbers into doubles that stand one behind the other.
#define PAIR(key_, type, first, second)                                                            \
    {                                                                                              \
        .key = (key_), .kind = DIG_YAML_LIST, .of = &dig_yaml_number,                              \
        .at   = offsetof(struct type, first),                                                      \
        .size = offsetof(struct type, second) + sizeof(double) - offsetof(struct type, first),     \
    }

/// A list of at least so many entries into member[], its length into count.
#define LIST(key, flag, type, member, count_, entry, least_)                                       \
    FIELD(LIST, key, type, member, flag, .of = (entry), .least = (least_),                         \
          .count =                                                                                 \
              offsetof(struct type, count_) *                                                      \
                  sizeof(char[sizeof(size_t) == sizeof(((struct type *)NULL)->count_) ? 1 : -1]) + \
              1)

/// A mapping into the member; one whose members stand in several parts of the struct around it; the
/// entry of a list that is one.
#define PART(key, flag, type, member, fields)                                                      \
    FIELD(MAPPING, key, type, member, flag, .of = (fields))
#define ACROSS(key_, flag, fields)                                                                 \
    {                                                                                              \
        .key = (key_), .kind = DIG_YAML_MAPPING, flag, .of = (fields)                              \
    }
#define ENTRY(type, fields)                                                                        \
    {                                                                                              \
        .kind = DIG_YAML_MAPPING, .size = sizeof(struct type), .of = (fields)                      \
    }

/// Where values come from, for people.
#define SOURCE                                                                                     \
    {                                                                                              \
        .key = "source", .kind = DIG_YAML_ANY, OPTIONAL                                            \
    }
#define END                                                                                        \
    {                                                                                              \
        .key = NULL                                                                                \
    }

extern const struct dig_yaml_field dig_yaml_number;
extern const struct dig_yaml_field dig_yaml_name; // of at most DIG_NAME_SIZE - 1 characters

/// A point of a polyline. core/ keeps its coordinates in two arrays.
struct dig_yaml_point {
    double xz_m[2];
};
extern const struct dig_yaml_field dig_yaml_point;

/// friction, rolling, density_kgpm3: into a struct dig_gravel.
extern const struct dig_yaml_field dig_yaml_gravel[];

#endif // DIG_FILES_YAML_YAML_SCHEMA_H
