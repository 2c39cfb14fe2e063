// Written by tools/make_reference.py from the code; change it there.

/** The version of recordings that this page knows. */
export const VERSION = 2;

/** The fields of a robot's row in a frame, in their order. */
export const ROBOT_STATE = ["x", "y", "yaw", "battery", "charging", "touching"];

/** The drawing of an unknown world. */
export const EMPTY = {
  "name": "",
  "bounds": null,
  "walls": [],
  "boxes": [],
  "furniture": [],
  "rooms": [],
  "docks": [],
  "doors": [],
  "cliffs": [],
  "robots": [],
  "people": [],
  "objects": []
};
