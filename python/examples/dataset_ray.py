# SPDX-License-Identifier: Apache-2.0
"""The data set of dataset.py, with its arguments, by workers of Ray (pip install ray): one for each processor.

    python dataset_ray.py [arguments of dataset.py]

RAY_ADDRESS=auto uses the cluster that this machine is part of; all its machines need the module and the same folder.
"""

import ray
from dataset import DataSet, arguments
from ray.util import ActorPool

options = arguments()
options.threads = 1
data = DataSet(options)
missing = data.missing()

ray.init(**({"num_cpus": 2} if options.quick else {}), log_to_driver=False)
Worker = ray.remote(num_cpus=1)(DataSet)  # each keeps its scene
workers = ActorPool([Worker.remote(options) for _ in range(int(ray.cluster_resources()["CPU"]))])
with data.manifest() as manifest:
    for line in workers.map_unordered(lambda worker, number: worker.make.remote(number), missing):
        manifest.write(line)
        manifest.flush()
print(f"{len(missing)} images rendered into {options.folder}")
