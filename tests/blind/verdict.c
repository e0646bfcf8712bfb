#include "tests/blind/verdict.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <yaml.h> // JSON is YAML

static yaml_node_t *value_of(yaml_document_t *const doc, const yaml_node_t *const map,
                             const char *const key)
{
    if (map == NULL || map->type != YAML_MAPPING_NODE) {
        return NULL;
    }
    for (yaml_node_pair_t *p = map->data.mapping.pairs.start; p < map->data.mapping.pairs.top;
         p++) {
        const yaml_node_t *const name = yaml_document_get_node(doc, p->key);
        if (strcmp((const char *)name->data.scalar.value, key) == 0) {
            return yaml_document_get_node(doc, p->value);
        }
    }
    return NULL;
}

static size_t items(const yaml_node_t *const list)
{
    return list != NULL && list->type == YAML_SEQUENCE_NODE
               ? (size_t)(list->data.sequence.items.top - list->data.sequence.items.start)
               : 0;
}

static yaml_node_t *item(yaml_document_t *const doc, const yaml_node_t *const list, const size_t i)
{
    return yaml_document_get_node(doc, list->data.sequence.items.start[i]);
}

static void copy(char to[DIG_NAME_SIZE], const yaml_node_t *const node)
{
    const bool text = node != NULL && node->type == YAML_SCALAR_NODE;
    (void)snprintf(to, DIG_NAME_SIZE, "%s", text ? (const char *)node->data.scalar.value : "?");
}

static double number(const yaml_node_t *const node)
{
    if (node == NULL || node->type != YAML_SCALAR_NODE ||
        strcmp((const char *)node->data.scalar.value, "null") == 0) {
        return (double)NAN;
    }
    return strtod((const char *)node->data.scalar.value, NULL);
}

// The 90 % interval of a number: {"value": …, "low": …, "high": …}.
static void interval(yaml_document_t *const doc, const yaml_node_t *const node, double *const low,
                     double *const high)
{
    *low  = number(value_of(doc, node, "low"));
    *high = number(value_of(doc, node, "high"));
}

static const yaml_node_t *first_value(yaml_document_t *const doc, const yaml_node_t *const map)
{
    const bool any = map != NULL && map->type == YAML_MAPPING_NODE &&
                     map->data.mapping.pairs.top > map->data.mapping.pairs.start;
    return any ? yaml_document_get_node(doc, map->data.mapping.pairs.start->value) : NULL;
}

static size_t names(yaml_document_t *const doc, const yaml_node_t *const list,
                    char to[BLIND_NAMES_MAX][DIG_NAME_SIZE])
{
    size_t n = 0;
    for (; n < items(list) && n < BLIND_NAMES_MAX; n++) {
        copy(to[n], item(doc, list, n));
    }
    return n;
}

static enum dig_status take(yaml_document_t *const doc, const char *const path,
                            struct blind_verdict *const v, struct dig_error *const error)
{
    static const char *const needed[] = { "significant", "verdict",     "indistinguishable",
                                          "effects",     "noise_floor", "error_before",
                                          "error_after", "material",    "metric" };
    yaml_node_t *const       root     = yaml_document_get_root_node(doc);
    for (size_t i = 0; i < sizeof needed / sizeof needed[0]; i++) {
        if (value_of(doc, root, needed[i]) == NULL) {
            return dig_error_set(error, DIG_EINVAL, "%s: no key \"%s\"", path, needed[i]);
        }
    }
    char flag[DIG_NAME_SIZE];
    copy(flag, value_of(doc, root, "significant"));
    v->significant = strcmp(flag, "true") == 0;
    v->names       = names(doc, value_of(doc, root, "verdict"), v->name);
    v->noise_floor = number(value_of(doc, root, "noise_floor"));
    v->before      = number(value_of(doc, value_of(doc, root, "error_before"), "holdout"));
    v->after       = number(value_of(doc, value_of(doc, root, "error_after"), "holdout"));

    const yaml_node_t *const effects = value_of(doc, root, "effects");
    for (; v->effects < items(effects) && v->effects < BLIND_NAMES_MAX; v->effects++) {
        const yaml_node_t *const effect = item(doc, effects, v->effects);
        copy(v->effect[v->effects], value_of(doc, effect, "name"));
        v->probability[v->effects] = number(value_of(doc, effect, "probability"));
        interval(doc, first_value(doc, value_of(doc, effect, "parameters")), &v->low[v->effects],
                 &v->high[v->effects]);
    }
    static const char *const axis[DIG_AXES] = { "friction", "rolling", "density_kgpm3" };
    const yaml_node_t *const material       = value_of(doc, root, "material");
    for (int a = 0; a < DIG_AXES; a++) {
        interval(doc, value_of(doc, material, axis[a]), &v->gravel_low.value[a],
                 &v->gravel_high.value[a]);
    }
    const yaml_node_t *const sets = value_of(doc, root, "indistinguishable");
    for (; v->sets < items(sets) && v->sets < BLIND_SETS_MAX; v->sets++) {
        v->set_size[v->sets] = names(doc, item(doc, sets, v->sets), v->set[v->sets]);
    }
    return v->names > 0 ? DIG_OK
                        : dig_error_set(error, DIG_EINVAL, "%s: the verdict is empty", path);
}

enum dig_status blind_verdict_read(const char *const path, struct blind_verdict *const verdict,
                                   struct dig_error *const error)
{
    FILE *const     file = fopen(path, "rb");
    yaml_parser_t   parser;
    yaml_document_t doc;
    if (file == NULL) {
        return dig_error_set(error, DIG_EIO, "%s: cannot be read", path);
    }
    struct blind_verdict v      = { .names = 0 };
    enum dig_status      status = DIG_EINVAL;
    (void)yaml_parser_initialize(&parser);
    yaml_parser_set_input_file(&parser, file);
    if (yaml_parser_load(&parser, &doc) == 0) {
        (void)dig_error_set(error, DIG_EINVAL, "%s: no JSON", path);
    } else {
        status = take(&doc, path, &v, error);
        yaml_document_delete(&doc);
    }
    yaml_parser_delete(&parser);
    (void)fclose(file);
    if (status == DIG_OK) {
        *verdict = v;
    }
    return status;
}
