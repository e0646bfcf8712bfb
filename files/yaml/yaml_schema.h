// Words for schemas: a file's numbers go straight into the structs they are for. Where their unit
// differs, as of angles, which arrive as degrees, who loads them converts them at once.

#ifndef DIG_FILES_YAML_YAML_SCHEMA_H
#define DIG_FILES_YAML_YAML_SCHEMA_H

#include <cyaml/cyaml.h>
#include <stddef.h>

#define REQUIRED CYAML_FLAG_DEFAULT
#define OPTIONAL CYAML_FLAG_OPTIONAL

/// Where values come from, for people: passed over.
#define SOURCE CYAML_FIELD_IGNORE("source", OPTIONAL)

/// A number or a text, its key the member's name.
#define NUMBER(type, member) CYAML_FIELD_FLOAT(#member, REQUIRED, struct type, member)
#define TEXT(type, member)   CYAML_FIELD_STRING(#member, REQUIRED, struct type, member, 1)

/// A list of numbers that fills the member, a vector or an array.
#define NUMBERS(key_, flags_, type_, member_)                                                      \
    {                                                                                              \
        .key = (key_), .data_offset = offsetof(struct type_, member_),                             \
        .value = { CYAML_VALUE_SEQUENCE_FIXED(flags_, double, &dig_yaml_number,                    \
                                              sizeof(((struct type_ *)NULL)->member_) /            \
                                                  sizeof(double)) },                               \
    }

/// Two numbers into members that stand one behind the other.
#define PAIR(key_, type_, first_, second_)                                                         \
    {                                                                                              \
        .key         = (key_),                                                                     \
        .data_offset = offsetof(struct type_, first_) +                                            \
                       0 * sizeof(char[offsetof(struct type_, second_) ==                          \
                                               offsetof(struct type_, first_) + sizeof(double)     \
                                           ? 1                                                     \
                                           : -1]),                                                 \
        .value = { CYAML_VALUE_SEQUENCE_FIXED(REQUIRED, double, &dig_yaml_number, 2) },            \
    }

/// A list into member[], its length into count.
#define LIST(key, flags, type, member, count, entry, least, most)                                  \
    CYAML_FIELD_SEQUENCE_COUNT(key, flags, struct type, member, count, entry, least, most)

/// An entry of a list that is a mapping; a whole file, which is one; a mapping whose members stand
/// in several parts of the struct around it.
#define ENTRY(type, fields)                                                                        \
    {                                                                                              \
        CYAML_VALUE_MAPPING(REQUIRED, struct type, fields)                                         \
    }
#define FILE_OF(type, fields)                                                                      \
    {                                                                                              \
        CYAML_VALUE_MAPPING(CYAML_FLAG_POINTER, struct type, fields)                               \
    }
#define ACROSS(key_, flags, type, fields)                                                          \
    {                                                                                              \
        .key = (key_), .value = { CYAML_VALUE_MAPPING(flags, struct type, fields) },               \
    }

extern const cyaml_schema_value_t dig_yaml_number;
extern const cyaml_schema_value_t dig_yaml_name; // of at most DIG_NAME_SIZE - 1 characters

/// A point of a polyline. core/ keeps its coordinates in two arrays.
struct dig_yaml_point {
    double xz_m[2];
};
extern const cyaml_schema_value_t dig_yaml_point;

/// friction, rolling, density_kgpm3: into a struct dig_gravel.
extern const cyaml_schema_field_t dig_yaml_gravel[];

#endif // DIG_FILES_YAML_YAML_SCHEMA_H
