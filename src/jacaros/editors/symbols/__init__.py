"""What names in programs mean: pure functions for editors, without a protocol.

An `Index` holds the occurrences of all names of one project. Build it from what the checker reads, and replace a program
after each edit; programs may have errors, as `jacaros.agents.language.loader.read_program` skips only broken clauses.

    from jacaros.editors.symbols.index import Index       # the other functions: `navigation`, `renaming`, `completion`, …
    index = Index(artifacts=types, actions=code.actions)
    index.put("src/agt/robot.asl", program)               # again after each edit
    index.put_project(file)                               # a .jcm or .mas2j file, for the beliefs and goals in it
    index = Index(types, actions, agents, before=index)   # a new one without programs; artifact types are read once
    occurrence_at(index, file, Position(3, 7))            # *file*: the text in the editor, a `SourceFile`
    definitions(index, file, at); references(index, file, at); highlights(index, file, at)
    renamable(index, file, at); rename(index, file, at, "charge")   # raise `RenameRefused`
    completions(index, file, at)
    hover(index, file, at)
    hints(index, file)                                    # or only those in a range of lines

    yaml_completions(file, at); yaml_hover(file, at)      # mapping, world, fault and project files

Positions count from 1, columns in characters (`model`). A file is known by its name in spans.
"""
