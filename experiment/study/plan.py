"""Assign participants to the four groups of the study: python plan.py 16 --seed 1 > groups.csv"""

import argparse
import random

GROUPS = (("agents A", "tree B"), ("tree A", "agents B"), ("agents B", "tree A"), ("tree B", "agents A"))
"""First and second part of each group: a side, and a set of requests."""


def assigned(participants: int, seed: int) -> list[int]:
    """Return the group, from 1, of each participant: groups differ by at most one participant."""
    draw = random.Random(seed)
    groups = list(range(1, len(GROUPS) + 1))
    drawn: list[int] = []
    while len(drawn) < participants:
        drawn += draw.sample(groups, len(groups))
    return drawn[:participants]


def main() -> None:
    """Print the plan as CSV."""
    parser = argparse.ArgumentParser(description="Assign participants to the four groups of the study.")
    parser.add_argument("participants", type=int)
    parser.add_argument("--seed", type=int, required=True, help="note it: the plan can then be checked")
    given = parser.parse_args()
    print("participant,group,first part,second part")
    for number, group in enumerate(assigned(given.participants, given.seed), 1):
        print(number, group, *GROUPS[group - 1], sep=",")


if __name__ == "__main__":
    main()
