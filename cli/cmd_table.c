/* ppscat table N: tables of the two papers, the printed figure beside ours.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <assert.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include "cli.h"
#include "commands.h"
#include "tables.h"

/* Options by bits. */
#define BIT(option) (UINT64_C(1) << OPT_##option)
#define OF_ALL (BIT(OUTPUT) | BIT(JOBS) | BIT(PROGRESS) | BIT(HELP) | BIT(VERSION))
#define OF_SOLVER (BIT(STREAMS) | BIT(NODES) | BIT(DELTA_M) | BIT(TOL) | BIT(TOL_OF))
static_assert(OPT_COUNT <= 64, "one bit an option");

static const struct {
    const char *name;
    uint64_t options; /* those it takes besides OF_ALL */
    int (*run)(const invocation *call);
} tables[] = {
    {"1", OF_SOLVER, table_1},
    {"2", OF_SOLVER, table_2},
    {"3", BIT(RAYS) | BIT(SEED), table_3},
    {"4", 0, table_4},
    {"5", 0, table_5},
    {"figure7", BIT(SAMPLES) | BIT(SEED), table_figure7},
    {"fps", 0, table_fps},
    {"crowns", BIT(RAYS) | BIT(SEED) | BIT(TREE_FILE), table_crowns},
};
enum { N_TABLES = sizeof tables / sizeof tables[0] };

/* The tables that take an option, or all of them: "1, 2". */
static const char *list_tables(uint64_t option, char *text, size_t size) {
    size_t used = 0;

    *text = '\0';
    for (size_t i = 0; i < N_TABLES && used < size; i++) {
        if (!option || (tables[i].options & option))
            used += (size_t)snprintf(text + used, size - used, "%s%s", used ? ", " : "",
                                     tables[i].name);
    }
    return text;
}

static int check_options(const invocation *call, size_t table) {
    char others[80];

    for (int id = 0; id < OPT_COUNT; id++) {
        uint64_t bit = UINT64_C(1) << id;
        if (option_given(call, (option_id)id) &&
            !((tables[table].options | OF_ALL) & bit))
            return cli_usage(
                "--%s: '%.60s' is not for table %s; allowed: with table %s",
                option_table[id].name, call->text[id], tables[table].name,
                list_tables(bit, others, sizeof others));
    }
    return CLI_DONE;
}

int cmd_table(const invocation *call) {
    char all[80];

    for (size_t i = 0; i < N_TABLES; i++) {
        if (call->operand && strcmp(tables[i].name, call->operand) == 0) {
            int rc = check_options(call, i);
            return rc == CLI_DONE ? tables[i].run(call) : rc;
        }
    }
    return cli_usage("table: no table '%.60s'; allowed: %s",
                     call->operand ? call->operand : "",
                     list_tables(0, all, sizeof all));
}

table_row table_blank(const char *table, const char *row, const char *column,
                      const char *method) {
    return (table_row){.table = table,
                       .row = row,
                       .column = column,
                       .method = method,
                       .paper = CSV_EMPTY,
                       .ours = CSV_EMPTY,
                       .rms_rel = CSV_EMPTY,
                       .ratio = CSV_EMPTY,
                       .spread = CSV_EMPTY,
                       .seconds_per_cell = CSV_EMPTY,
                       .rms_leaf = CSV_EMPTY,
                       .seconds_per_leaf = CSV_EMPTY};
}

int table_write(output *out, const table_row *row) {
    csv_text(&out->csv, row->table);
    csv_text(&out->csv, row->row);
    csv_text(&out->csv, row->column);
    csv_number(&out->csv, row->paper);
    csv_number(&out->csv, row->ours);
    csv_number(&out->csv, row->rms_rel);
    csv_text(&out->csv, row->method);
    csv_number(&out->csv, row->ratio);
    csv_number(&out->csv, row->spread);
    csv_number(&out->csv, row->seconds_per_cell);
    csv_number(&out->csv, row->rms_leaf);
    csv_number(&out->csv, row->seconds_per_leaf);
    return output_end_row(out, row->refused_by, row->refusal);
}
