"""Maps of the ground that agents share with a robot.

================================ ======================================================================
file                             what it holds
================================ ======================================================================
`slam_data`                      ``ArtSlamData`` of the thesis: cells that agents label, range of view,
                                 routes
`cells`                          cells and their labels
`route`                          the shortest way over free cells, and its first step
================================ ======================================================================
"""
