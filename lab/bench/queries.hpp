#pragma once

#include "systems.hpp"
#include "task.hpp"

/// The measured parts of a query.
enum class Question { Sides, Contacts };

/// "contains" or "contacts"
const char* name_of(Question question);

/// The effort that asks one of the two.
echinus::comparison::Effort effort_for(Question question, const Setting& setting);

/// Built systems, ready for queries.
struct BuiltSystems {
    std::vector<BenchSystem> list;
    std::vector<echinus::comparison::TimedBuild> builds;

    std::vector<const echinus::rivals::System*> pointers() const;
};
BuiltSystems build_all(std::vector<BenchSystem> systems);

/// The columns of the records of queries, and others.
Records query_records(const std::vector<std::string>& more = {});

/// Lets all systems answer for a set, and adds a record for each. Judges the set if it is not yet judged.
void add_queries(const Setting& setting, const Subject& subject, echinus::comparison::JudgedSet& set,
                 const BuiltSystems& systems, const echinus::comparison::Effort& effort, Records& records);
