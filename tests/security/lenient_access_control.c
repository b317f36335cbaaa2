/* SPDX-License-Identifier: Apache-2.0 */
/* DDS Security's access control, but what its own side's permissions forbid is let through: how somebody with a valid identity
 * would go beyond its role. Others' checks are all that is left. Initialized and ended as the plugin that it wraps, whose path is
 * in PALPATE_ACCESS_CONTROL. */
#include <dds/security/dds_security_api.h>
#include <dlfcn.h>
#include <stdlib.h>

static void* plugin(void) {
  const char* const path = getenv("PALPATE_ACCESS_CONTROL");
  return path == NULL ? NULL : dlopen(path, RTLD_NOW);
}

static DDS_Security_boolean writerMayBe(dds_security_access_control* instance,
                                        const DDS_Security_PermissionsHandle permissions,
                                        const DDS_Security_DomainId domain, const DDS_Security_char* topic,
                                        const DDS_Security_Qos* qos,
                                        const DDS_Security_PartitionQosPolicy* partition,
                                        const DDS_Security_DataTags* tags,
                                        DDS_Security_SecurityException* exception) {
  (void)instance, (void)permissions, (void)domain, (void)topic, (void)qos, (void)partition, (void)tags,
      (void)exception;
  return true;
}

/* What says that permissions have expired: its own side would leave then. */
static DDS_Security_boolean nobodyListens(dds_security_access_control* instance,
                                          const dds_security_access_control_listener* listener,
                                          DDS_Security_SecurityException* exception) {
  (void)instance, (void)listener, (void)exception;
  return true;
}

int init_access_control(const char* argument, void** context, struct ddsi_domaingv* gv) {
  void* const library = plugin();
  const plugin_init wrapped = library == NULL ? NULL : (plugin_init)dlsym(library, "init_access_control");
  if (wrapped == NULL || wrapped(argument, context, gv) != 0) return -1;
  dds_security_access_control* const control = *context;
  control->check_create_datawriter = &writerMayBe;
  control->set_listener = &nobodyListens;
  return 0;
}

int finalize_access_control(void* context) {
  void* const library = plugin();
  const plugin_finalize wrapped =
      library == NULL ? NULL : (plugin_finalize)dlsym(library, "finalize_access_control");
  return wrapped == NULL ? -1 : wrapped(context);
}
