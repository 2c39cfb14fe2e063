[(plan) (block) (sub_plans) (comment)] @fold
